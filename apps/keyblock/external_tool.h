#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace keyblock::app {

/// A program of others that a command needs.
struct ExternalTool {
  const char* name;     ///< on the PATH
  const char* package;  ///< of Debian
  const char* purpose;  ///< "PNG and PDF are made by it"
  const char* without;  ///< what can be had without it
};
inline constexpr ExternalTool svg_converter{
    "rsvg-convert", "librsvg2-bin", "PDF and PNG are made of SVG by it", "SVG needs nothing: -o NAME.svg"};
inline constexpr ExternalTool film_maker{
    "ffmpeg", "ffmpeg",
    "pictures are put together to a film by it (built with librsvg, as that of Debian is)",
    "the report, report.html, shows the run as a film without it"};

/// Where it is. Throws InputError with the package that brings it.
std::filesystem::path find_tool(const ExternalTool& tool);

/// Runs it to its end. Throws RunError with what it has said when it fails, or when the user has interrupted.
void run_tool(const std::filesystem::path& tool, const std::vector<std::string>& arguments);

/// A folder for files in between, beside `path`; it goes with the object.
class WorkFolder {
 public:
  explicit WorkFolder(const std::filesystem::path& path);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  std::filesystem::path folder_;
};

}  // namespace keyblock::app
