#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Job arrays of Slurm. Element e of an array does the runs e·n … e·n + n − 1 of the plan, n runs per task; arrays beyond
/// what Slurm takes as index (MaxArraySize) count from an offset.
namespace keyblock::study {

struct SlurmOptions {
  std::string program;  ///< path of keyblock
  std::string time, memory, partition, account, qos,
      constraint;                  ///< as for sbatch; empty: the cluster's defaults
  std::vector<std::string> lines;  ///< more options, one `#SBATCH` each: `--gres=tmp:10G`
  int most_running = 0;            ///< tasks at a time; 0: no limit
  int runs_per_task = 1;
  std::size_t most_elements = 1001;  ///< MaxArraySize
};

struct ArrayScript {
  std::string name;  ///< file in DIR: array.sbatch; array-2.sbatch … where one is not enough
  std::string text;
  std::string elements;  ///< as for --array: "3,7-20%4"
};

/// Throws InputError when Slurm takes no arrays (most_elements = 0), for options that are not one word, lines that are no options, and for a path that
/// `#SBATCH --output` cannot hold: with a double quote, a backslash or a control character.
void check_can_submit(const std::filesystem::path& directory, const SlurmOptions& options);

/// One script, or several, for these runs (ascending indices) of the study in `directory` (absolute), which can be submitted.
std::vector<ArrayScript> array_scripts(const std::filesystem::path& directory,
                                       const std::vector<std::size_t>& runs, const SlurmOptions& options);

/// Whether a file of that name in DIR is one of them, of this call or an earlier one.
bool is_array_script(const std::string& name);

/// Whether a file with this text is a script of this or another call, and no file of the user.
bool is_own_script(const std::string& text);

/// A script that gathers the study.
std::string collect_script(const std::filesystem::path& directory, const SlurmOptions& options);

/// `3,7-20` for ascending numbers.
std::string index_ranges(const std::vector<std::size_t>& numbers);

/// MaxArraySize of `scontrol show config`; nothing when the text does not have it.
std::optional<std::size_t> max_array_size(const std::string& config);

/// 'text', safe for a shell.
std::string shell_quoted(const std::string& text);

}  // namespace keyblock::study
