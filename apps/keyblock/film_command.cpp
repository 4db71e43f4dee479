#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/folder.h"
#include "core/parallel.h"
#include "external_tool.h"
#include "interrupt.h"
#include "picture_arguments.h"

namespace keyblock::app {
namespace {

namespace fs = std::filesystem;

struct FilmArguments {
  PictureArguments picture;
  double rate = 25.0;  ///< pictures per second
};

std::vector<std::string> codec_of(const std::string& format) {
  // Of the widths and formats of pixels that all players have.
  if (format == ".mp4")
    return {"-c:v", "libx264",  "-preset", "veryfast",  "-crf",
            "20",   "-pix_fmt", "yuv420p", "-movflags", "+faststart"};
  if (format == ".webm")
    return {"-c:v", "libvpx-vp9", "-crf", "32", "-b:v", "0", "-cpu-used", "8", "-pix_fmt", "yuv420p"};
  if (format == ".gif") return {"-vf", "scale=800:-1,split[a][b];[a]palettegen[p];[b][p]paletteuse"};
  Diagnostic diagnostic;
  diagnostic.key = "-o";
  diagnostic.found = "a film that ends in '" + format + "'";
  diagnostic.expected = ".mp4, .webm or .gif";
  throw InputError(std::move(diagnostic));
}

// ffmpeg of Debian reads SVG itself: a converter of its own would be started once for every frame, which takes four times as long.
void draw_frames(const picture::SectionPicture& picture, std::size_t count, const WorkFolder& work) {
  const std::atomic<bool>& stopped = stop_on_interrupt();
  ThreadTeam team(processors());
  team.for_range(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end && !stopped; ++f) {
      AtomicFile file(work / fmt::format("{:06}.svg", f));
      file.write(picture.draw(f));
      file.publish();  // a file in between need not outlast a loss of power
    }
  });
  if (stopped) throw RunError("interrupted");
}

void make_film(const FilmArguments& arguments) {
  const fs::path output = arguments.picture.output;
  const std::string format = output.extension().string();
  std::vector<std::string> codec = codec_of(format);
  const fs::path ffmpeg = find_tool(film_maker);
  const results::RunData run = read_frames(arguments.picture.folder);
  check_can_write(output);
  const picture::SectionPicture picture(run, arguments.picture.options);
  const WorkFolder work(output);
  draw_frames(picture, run.frames.size(), work);
  const fs::path made = work / ("film" + format);
  std::vector<std::string> words{
      "-v", "error", "-framerate", fmt::format("{:g}", arguments.rate), "-i", (work / "%06d.svg").string()};
  words.insert(words.end(), codec.begin(), codec.end());
  words.push_back(made.string());
  run_tool(ffmpeg, words);
  write_file_atomically(output, read_file(made));
  std::cout << fmt::format("film of {} frames, {:.1f} s: {}\n", run.frames.size(),
                           static_cast<double>(run.frames.size()) / arguments.rate, output.string());
}

}  // namespace

void add_film(CLI::App& app) {
  auto arguments = std::make_shared<FilmArguments>();
  CLI::App* command = app.add_subcommand("film", "All frames of a run as a film: MP4, WebM or GIF");
  add_picture_arguments(*command, arguments->picture);
  command->add_option("-o,--output", arguments->picture.output, "A file that ends in .mp4, .webm or .gif")
      ->required()
      ->type_name("FILE");
  command->add_option("--rate", arguments->rate, "Frames of the run per second of the film")
      ->check(CLI::Range(0.1, 120.0).description(""))
      ->capture_default_str()
      ->type_name("N");
  command->footer("Example:\n  keyblock film out/tunnel --color status -o fall.mp4");
  command->callback([arguments] { make_film(*arguments); });
}

}  // namespace keyblock::app
