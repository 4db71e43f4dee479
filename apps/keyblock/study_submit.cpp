#include <fmt/format.h>
#include <sys/wait.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/folder.h"
#include "scenario_arguments.h"
#include "study/collect.h"
#include "study/folder.h"
#include "study/slurm.h"
#include "study_commands.h"

namespace keyblock::app {
namespace {

namespace fs = std::filesystem;

struct SubmitArguments {
  ScenarioArguments scenario;
  std::string folder;
  bool resume = false;
  bool now = false;
  study::SlurmOptions slurm;
};

/// What a command of the shell prints on standard output, and the code it exits with; −1: by a signal.
std::pair<std::string, int> output_of(const std::string& command) {
  FILE* pipe = ::popen(command.c_str(), "r");  // NOLINT(cert-env33-c): the words are quoted
  if (pipe == nullptr) throw RunError("cannot start a shell");
  std::string text;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    text.append(buffer.data(), n);
  const int status = ::pclose(pipe);
  return {text, WIFEXITED(status) ? WEXITSTATUS(status) : -1};
}

/// The number of the job.
std::string submit(const fs::path& script, const std::string& options) {
  const auto [text, code] =
      output_of(fmt::format("sbatch --parsable {} {}", options, study::shell_quoted(script.string())));
  if (code != 0) throw RunError(fmt::format("sbatch did not take {} (exit code {})", script.string(), code));
  const std::string job = text.substr(0, text.find_first_of(";\n"));
  if (job.empty() || job.find_first_not_of("0123456789") != std::string::npos)
    throw RunError(fmt::format("sbatch said no number of a job for {}", script.string()));
  return job;
}

void submit_all(const fs::path& folder, const std::vector<study::ArrayScript>& scripts) {
  std::string jobs;
  for (const study::ArrayScript& script : scripts) {
    const std::string job = submit(folder / script.name, "");
    std::cout << "job " << job << ": array " << script.elements << std::endl;
    jobs += ":" + job;
  }
  std::cout << "job " << submit(folder / "collect.sbatch", "--dependency=afterany" + jobs)
            << ": collects what they leave" << std::endl;
}

/// What would be written over must be a script of an earlier submission.
void check_is_own(const fs::path& script) {
  if (!file_exists(script) || study::is_own_script(read_own_file(script))) return;
  Diagnostic diagnostic;
  diagnostic.where.file = script.string();
  diagnostic.found = "a file that is no script of keyblock";
  diagnostic.expected = "another folder, or another name for the file";
  throw InputError(std::move(diagnostic));
}

/// Scripts of an earlier submission that took more arrays would run what they were not meant for.
void remove_scripts(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (study::is_array_script(entry.path().filename().string())) found.push_back(entry.path());
  }
  for (const fs::path& path : found) check_is_own(path);
  check_is_own(folder / "collect.sbatch");
  for (const fs::path& path : found) fs::remove(path);
}

/// What is easily forgotten, and found out when the first hundred tasks have ended.
void add_warnings(const study::SlurmOptions& slurm, std::vector<std::string>& warnings) {
  if (slurm.time.empty())
    warnings.emplace_back(
        "no --time: tasks have the limit that the cluster gives by default, which may be minutes");
  if (slurm.memory.empty())
    warnings.emplace_back("no --mem: tasks have the memory that the cluster gives by default");
  if (std::string_view(KEYBLOCK_PROCESSOR) == "native") {
    warnings.emplace_back(
        "this program was built for the processor of this machine; nodes with an older one refuse it "
        "(--constraint chooses nodes, "
        "packages are for all)");
  }
}

void submit_study(SubmitArguments& arguments) {
  std::vector<std::string> warnings;
  study::Plan plan =
      study::make_plan(arguments.scenario.file, arguments.scenario.overrides, KEYBLOCK_VERSION, &warnings);
  add_warnings(arguments.slurm, warnings);
  print_warnings(arguments.scenario, warnings);
  const auto limit = study::max_array_size(output_of("scontrol show config 2>/dev/null").first);
  if (limit) arguments.slurm.most_elements = *limit;
  arguments.slurm.program = fs::read_symlink("/proc/self/exe").string();
  study::check_can_submit(fs::absolute(arguments.folder), arguments.slurm);
  const auto lock = study::lock_study(arguments.folder);
  study::enter_plan(arguments.folder, plan, arguments.resume);
  study::StudyFiles files = study::read_study_files(arguments.folder, plan);
  study::forget_failures(arguments.folder, plan, files);
  std::vector<std::size_t> runs;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    if (files.asked(plan.runs[k]) && files.states[k].kind != study::RunState::Kind::done) runs.push_back(k);
  }
  const fs::path folder = fs::canonical(arguments.folder);
  remove_scripts(folder);
  if (runs.empty()) {
    std::cout << "all runs are done; keyblock study collect " << arguments.folder << " gathers them"
              << std::endl;
    return;
  }
  make_plain_folder(folder / "slurm");
  const auto scripts = study::array_scripts(folder, runs, arguments.slurm);
  for (const study::ArrayScript& script : scripts) write_file_atomically(folder / script.name, script.text);
  write_file_atomically(folder / "collect.sbatch", study::collect_script(folder, arguments.slurm));
  std::cout << runs.size() << " of " << plan.wanted() << " runs to be done" << std::endl;
  if (arguments.now) return submit_all(folder, scripts);
  for (const study::ArrayScript& script : scripts)
    std::cout << "sbatch " << study::shell_quoted((folder / script.name).string()) << "\n";
  std::cout << "then: keyblock study collect " << study::shell_quoted(folder.string()) << std::endl;
}

}  // namespace

void add_study_submit(CLI::App& study) {
  auto arguments = std::make_shared<SubmitArguments>();
  CLI::App* command =
      study.add_subcommand("submit", "Plan a study and write it as a job array of Slurm, or submit it");
  add_scenario_file(*command, arguments->scenario);
  add_study_folder(*command, arguments->folder);
  command->add_flag("--now", arguments->now, "Submit the array, and a job that collects when it has ended");
  command->add_flag("--resume", arguments->resume, "Only the runs that the study in DIR has not done");
  command->add_option("--time", arguments->slurm.time, "Limit of a task, as for sbatch")->type_name("TIME");
  command->add_option("--mem", arguments->slurm.memory, "Memory of a task, as for sbatch")->type_name("SIZE");
  command->add_option("--partition", arguments->slurm.partition, "As for sbatch")->type_name("NAME");
  command
      ->add_option("--account", arguments->slurm.account,
                   "As for sbatch; many clusters refuse jobs without one")
      ->type_name("NAME");
  command->add_option("--qos", arguments->slurm.qos, "As for sbatch")->type_name("NAME");
  command->add_option("--constraint", arguments->slurm.constraint, "Features of nodes, as for sbatch")
      ->type_name("LIST");
  command
      ->add_option("--sbatch", arguments->slurm.lines,
                   "Another option for sbatch, as --sbatch=--gres=tmp:10G; once for each")
      ->type_name("OPTION")
      ->allow_extra_args(false);
  command->add_option("--max-running", arguments->slurm.most_running, "Tasks at a time")
      ->check(CLI::Range(1, 1000000).description(""))
      ->type_name("N");
  command
      ->add_option("--per-task", arguments->slurm.runs_per_task, "Runs that a task does one after the other")
      ->check(CLI::Range(1, 1000000).description(""))
      ->capture_default_str()
      ->type_name("N");
  command->footer(
      "Examples:\n"
      "  keyblock study submit tunnel.toml -o out/study --time 1:00:00 --mem 2G\n"
      "  keyblock study submit tunnel.toml -o out/study --now --resume");
  command->callback([arguments] { submit_study(*arguments); });
}

}  // namespace keyblock::app
