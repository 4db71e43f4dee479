#include "study/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>

namespace keyblock::study {
namespace {

// What both kinds of script begin with.
std::string head(const std::string& job, const std::filesystem::path& log, const SlurmOptions& options) {
  std::string text =
      fmt::format("#!/bin/bash\n#SBATCH --job-name={}\n#SBATCH --output=\"{}\"\n", job, log.string());
  text += "#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1\n";
  if (!options.time.empty()) text += "#SBATCH --time=" + options.time + "\n";
  if (!options.memory.empty()) text += "#SBATCH --mem=" + options.memory + "\n";
  if (!options.partition.empty()) text += "#SBATCH --partition=" + options.partition + "\n";
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
    if (digit != line.end()) return std::stoul(std::string(digit, line.end()));
  }
  return std::nullopt;
}

std::vector<ArrayScript> array_scripts(const std::filesystem::path& directory,
                                       const std::vector<std::size_t>& runs, const SlurmOptions& options) {
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
    script.text = head("keyblock", directory / "slurm" / "%A_%a.log", options) +
                  "#SBATCH --array=" + script.elements + "\n\n" +
                  task_commands(directory, array * options.most_elements, runs.back(), options);
    scripts.push_back(std::move(script));
  }
  return scripts;
}

std::string collect_script(const std::filesystem::path& directory, const SlurmOptions& options) {
  return head("keyblock-collect", directory / "slurm" / "%j.log", options) +
         fmt::format("\nexec {} study collect {}\n", shell_quoted(options.program),
                     shell_quoted(directory.string()));
}

}  // namespace keyblock::study
