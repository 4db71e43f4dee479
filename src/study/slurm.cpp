#include "study/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/text.h"
#include "study/refusal.h"

namespace keyblock::study {
namespace {

// For --output, in which % begins a symbol that sbatch replaces.
std::string log_pattern(const std::filesystem::path& directory, const std::string& name) {
  std::string text;
  for (const char c : directory.string()) text += c == '%' ? std::string("%%") : std::string(1, c);
  return text + "/slurm/" + name;
}

constexpr std::string_view script_begin = "#!/bin/bash\n#SBATCH --job-name=keyblock";

/// Options of one word, with their names for sbatch.
std::vector<std::pair<const char*, const std::string*>> word_options(const SlurmOptions& options) {
  return {{"--time", &options.time},       {"--mem", &options.memory}, {"--partition", &options.partition},
          {"--account", &options.account}, {"--qos", &options.qos},    {"--constraint", &options.constraint}};
}

// What both kinds of script begin with.
std::string head(const std::string& job, const std::string& log, const SlurmOptions& options) {
  std::string text = fmt::format("{}{}\n#SBATCH --output=\"{}\"\n", script_begin, job, log);
  text += "#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1\n";
  for (const auto& [name, value] : word_options(options)) {
    if (!value->empty()) text += fmt::format("#SBATCH {}={}\n", name, *value);
  }
  for (const std::string& line : options.lines) text += "#SBATCH " + line + "\n";
  return text;
}

std::string task_commands(const std::filesystem::path& directory, std::size_t offset, std::size_t last,
                          const SlurmOptions& options) {
  const std::string command =
      fmt::format("{} study task {}", shell_quoted(options.program), shell_quoted(directory.string()));
  const std::string element =
      offset == 0 ? "SLURM_ARRAY_TASK_ID" : fmt::format("(SLURM_ARRAY_TASK_ID + {})", offset);
  if (options.runs_per_task == 1) return fmt::format("exec {} $(({}))\n", command, element);
  return fmt::format(
      "first=$(({0} * {1}))\n"
      "status=0\n"
      "for ((run = first; run < first + {1} && run <= {2}; ++run)); do\n"
      "  {3} \"$run\" || status=$?\n"
      "done\n"
      "exit $status\n",
      element, options.runs_per_task, last, command);
}

}  // namespace

std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string index_ranges(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t k = 0; k < numbers.size();) {
    std::size_t end = k;
    while (end + 1 < numbers.size() && numbers[end + 1] == numbers[end] + 1) ++end;
    text += (text.empty() ? "" : ",") + std::to_string(numbers[k]);
    if (end > k) text += "-" + std::to_string(numbers[end]);
    k = end + 1;
  }
  return text;
}

std::optional<std::size_t> max_array_size(const std::string& config) {
  std::istringstream lines(config);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("MaxArraySize")) continue;
    const auto digit =
        std::find_if(line.begin(), line.end(), [](unsigned char c) { return std::isdigit(c); });
    const std::string number(digit, line.end());
    std::size_t size = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), size);
    if (error == std::errc{}) return size;
  }
  return std::nullopt;
}

namespace {

// In a line of options, sbatch splits words at spaces, takes quotes and backslashes away, and ends the line at a #.
void check_option(const char* option, const std::string& text) {
  const auto is_wrong = [](unsigned char c) {
    return c <= ' ' || c == 0x7F ||
           std::string_view("\"'\\#").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (std::none_of(text.begin(), text.end(), is_wrong)) return;
  refuse(option, '"' + text + '"', "one word without spaces, line breaks, quotes, \\ and #");
}

bool has_control(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](const char& c) { return is_control({&c, 1}); });
}

void check_line(const std::string& line) {
  if (!line.starts_with("-") || has_control(line))
    refuse("--sbatch", '"' + line + '"', "one option of sbatch, as --gres=tmp:10G");
}

}  // namespace

void check_can_submit(const std::filesystem::path& directory, const SlurmOptions& options) {
  if (options.most_elements == 0) {
    refuse("", "MaxArraySize = 0 in the configuration of Slurm: it takes no job arrays",
           "a cluster that takes job arrays", "keyblock study run does all runs on one machine");
  }
  for (const auto& [name, value] : word_options(options)) check_option(name, *value);
  for (const std::string& line : options.lines) check_line(line);
  const std::string folder = directory.string();
  if (folder.find_first_of("\"\\") != std::string::npos || has_control(folder)) {
    refuse(folder, "a double quote, a backslash or a line break in the path",
           "a folder that sbatch can be told to write its logs to");
  }
  if (has_control(options.program))
    refuse(options.program, "a line break in the path", "the program at another place");
}

std::vector<ArrayScript> array_scripts(const std::filesystem::path& directory,
                                       const std::vector<std::size_t>& runs, const SlurmOptions& options) {
  check_can_submit(directory, options);
  const auto per_task = static_cast<std::size_t>(std::max(1, options.runs_per_task));
  std::map<std::size_t, std::vector<std::size_t>> arrays;
  for (const std::size_t run : runs) {
    const std::size_t element = run / per_task;
    std::vector<std::size_t>& list = arrays[element / options.most_elements];
    const std::size_t index = element % options.most_elements;
    if (list.empty() || list.back() != index) list.push_back(index);
  }
  std::vector<ArrayScript> scripts;
  for (const auto& [array, elements] : arrays) {
    ArrayScript script;
    script.name = scripts.empty() ? "array.sbatch" : fmt::format("array-{}.sbatch", scripts.size() + 1);
    script.elements = index_ranges(elements);
    if (options.most_running > 0) script.elements += fmt::format("%{}", options.most_running);
    script.text = head("", log_pattern(directory, "%A_%a.log"), options) +
                  "#SBATCH --array=" + script.elements + "\n\n" +
                  task_commands(directory, array * options.most_elements, runs.back(), options);
    scripts.push_back(std::move(script));
  }
  return scripts;
}

bool is_own_script(const std::string& text) {
  return text.starts_with(script_begin);
}

bool is_array_script(const std::string& name) {
  const std::string begin = "array", end = ".sbatch";
  if (!name.starts_with(begin) || !name.ends_with(end) || name.size() < begin.size() + end.size())
    return false;
  const std::string number = name.substr(begin.size(), name.size() - begin.size() - end.size());
  return number.empty() || (number.size() > 1 && number[0] == '-' &&
                            std::all_of(number.begin() + 1, number.end(),
                                        [](unsigned char c) { return std::isdigit(c) != 0; }));
}

std::string collect_script(const std::filesystem::path& directory, const SlurmOptions& options) {
  return head("-collect", log_pattern(directory, "%j.log"), options) +
         fmt::format("\nexec {} study collect {}\n", shell_quoted(options.program),
                     shell_quoted(directory.string()));
}

}  // namespace keyblock::study
