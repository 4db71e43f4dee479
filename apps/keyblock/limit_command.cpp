#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "commands.h"
#include "core/error.h"
#include "interrupt.h"
#include "limit_arguments.h"
#include "record/standing.h"
#include "study/folder.h"
#include "study/limit_search.h"
#include "study/limit_words.h"
#include "study_progress.h"

namespace keyblock::app {
namespace {

using Status = study::Bisection::Status;

void tell_trial(const study::LimitRequest& request, const study::RealizationLimit& limit,
                const study::LimitTrial& trial) {
  const std::string which =
      request.realizations > 1 ? fmt::format("realization {}, ", limit.realization) : "";
  std::string measured = record::standing_name(trial.standing);
  if (request.criterion.by_measure) {
    const std::string also = trial.standing == record::Standing::stands ? "" : ", " + measured;
    measured = fmt::format("{} {:.5g}{}", request.criterion.measure, trial.measure, also);
  }
  std::cout << fmt::format("{}{} = {:.8g}: {}, {}\n", which, request.key, trial.value, measured,
                           trial.met ? "met" : "not met")
            << std::flush;
}

// What a search of one realization, whose ends tell nothing of a limit, should have been.
void refuse_ends(const study::LimitResult& result) {
  const auto& limit = result.realizations.front();
  const auto& request = result.request;
  const auto end = [&](const char* option, double value, const char* found, const char* expected,
                       const std::string& hint) {
    Diagnostic diagnostic;
    diagnostic.where.file = fmt::format("{} {:.8g}", option, value);
    diagnostic.key = request.key;
    diagnostic.found = fmt::format("{} ({})", found, request.criterion.text());
    diagnostic.expected = expected;
    diagnostic.hint = hint;
    throw InputError(std::move(diagnostic));
  };
  constexpr const char* without = "a value at which the criterion does not hold";
  constexpr const char* with = "a value at which the criterion holds";
  switch (limit.state.status) {
    case Status::ends_swapped:
      return end("--from", request.from, "that the criterion holds, and that it does not at --to", without,
                 "exchange --from and --to");
    case Status::met_at_both:
      return end(
          "--from", request.from, "that the criterion holds at both ends", without,
          request.key == study::safety_key
              ? "move --from away from --to; where rock moves before its strength is reduced, as the run at "
                "--from tells, there is no factor"
          : request.criterion.by_standing
              ? "move --from away from --to"
              : "move --from away from --to, raise --above, or count from a later stage with --since");
    case Status::met_at_none:
      return end("--to", request.to, "that the criterion holds at neither end", with,
                 study::not_met_hint(result));
    case Status::found:
    case Status::open:
      return;
  }
}

void tell_result(const study::LimitResult& result, const std::string& folder) {
  std::cout << "\n" << study::limit_text(result);
  for (const auto& limit : result.realizations) {
    const study::LimitTrial* beyond = limit.just_beyond();
    if (beyond == nullptr || result.realizations.size() > 1) continue;
    const std::filesystem::path page = study::run_folder(folder, beyond->run) / "report.html";
    if (std::filesystem::exists(page)) std::cout << "just beyond it: " << page.string() << "\n";
  }
  std::cout << "report: " << folder << "/report.html" << std::endl;
}

}  // namespace

void run_limit(LimitArguments arguments) {
  study::Plan plan =
      study::plan_limit(study::read_scenario_text(arguments.scenario.file, arguments.scenario.overrides),
                        KEYBLOCK_VERSION, arguments.request, arguments.until, arguments.above);
  print_warnings(arguments.scenario, plan.warnings);
  const auto lock = study::lock_study(arguments.folder);
  StudyDisplay display = StudyDisplay::to_standard_error("limit");
  study::LimitOptions options;
  options.resume = arguments.resume;
  options.workers.workers = arguments.workers;
  options.workers.command = {"/proc/self/exe", "study", "task"};
  options.workers.stop = &stop_on_interrupt();
  options.workers.report = [&](const study::StudyProgress& progress) { display.show(progress); };
  options.trial = [&](const study::RealizationLimit& limit, const study::LimitTrial& trial) {
    display.end();
    tell_trial(arguments.request, limit, trial);
  };
  bool interrupted = false;
  const study::LimitResult result =
      study::find_limit(arguments.folder, std::move(plan), arguments.request, options, interrupted);
  display.end();
  tell_result(result, arguments.folder);
  if (interrupted)
    throw RunError(fmt::format("interrupted; --resume goes on from what is kept in {}", arguments.folder));
  const auto failed = std::count_if(result.realizations.begin(), result.realizations.end(),
                                    [](const auto& limit) { return !limit.error.empty(); });
  if (failed > 0)
    throw RunError(
        fmt::format("{} of {} searches failed; --resume tries again", failed, result.realizations.size()));
  if (result.realizations.size() == 1) refuse_ends(result);
}

void add_limit_folder(CLI::App& command, LimitArguments& arguments) {
  command
      .add_option("-o,--output", arguments.folder,
                  "Folder of the limit: limit.json, limits.csv, report.html, runs/")
      ->required()
      ->type_name("DIR");
  command
      .add_option("--workers", arguments.workers,
                  "Runs at a time, each a process of one thread; any number gives the same limit")
      ->check(CLI::Range(1, 4096).description(""))
      ->capture_default_str()
      ->type_name("N");
}

void add_limit_realizations(CLI::App& command, study::LimitRequest& request) {
  command
      .add_option("--realizations", request.realizations,
                  "A limit for each of realizations 0 … N-1, their median and other quantiles")
      ->check(CLI::Range(1, 100000).description(""))
      ->capture_default_str()
      ->type_name("N");
}

namespace {

/// The table of default criteria, a line each.
std::string default_criteria() {
  std::string text = "Without --until:\n";
  for (const study::LimitDefault& row : study::limit_defaults())
    text += fmt::format("  {}: {}, as {}\n", row.what, row.criterion, row.why);
  return text;
}

/// What is looked for, and where.
void add_search_options(CLI::App& command, LimitArguments& arguments) {
  study::LimitRequest& request = arguments.request;
  command.add_option("--key", request.key, "Key path of the number, as for --set")
      ->required()
      ->type_name("KEY");
  command.add_option("--from", request.from, "A value at which the criterion does not hold")
      ->required()
      ->type_name("A");
  command.add_option("--to", request.to, "A value at which it holds")->required()->type_name("B");
  command
      .add_option(
          "--until", arguments.until,
          "What is to hold at the end of the last stage: fallen (area of fallen rock), moved (largest "
          "displacement), collapsed (the blocks do not stand), gives_way (they do not stand, or have moved "
          "since the stage began), or a measure of summary.json by its name; "
          "default: by the model, see below")
      ->type_name("CRITERION");
  command
      .add_option(
          "--above", arguments.above,
          "It holds when the measure is above this; default: 0, for moved loosened_distance of [damage]")
      ->type_name("X");
  command
      .add_option("--since", request.since,
                  "Stage at whose end the measure begins: what came down before does not count; default: it "
                  "begins at the first excavation")
      ->type_name("STAGE");
  command
      .add_option("--tolerance", request.tolerance,
                  "Where the bisection ends: width of the bracket over the larger of its ends")
      ->capture_default_str()
      ->type_name("T");
  command
      .add_option("--scan", request.scan,
                  "Look at N equal parts of the way before the bisection, and find all limits that show; "
                  "default: 8 for the scale of a motion, which need not be monotone, else 1")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N");
  add_limit_realizations(command, request);
}

}  // namespace

void add_limit(CLI::App& app) {
  auto arguments = std::make_shared<LimitArguments>();
  CLI::App* command = app.add_subcommand(
      "limit",
      "Bisection over a number of the scenario for the value at which rock first falls, moves or collapses");
  add_scenario_file(*command, arguments->scenario);
  add_search_options(*command, *arguments);
  add_limit_folder(*command, *arguments);
  command->add_flag("--resume", arguments->resume,
                    "Go on with the runs in DIR; --from, --to, --until, --above, --since, --tolerance, "
                    "--scan and --realizations may change");
  command->footer(
      "Each trial is a run of its own, kept in DIR/runs. Where collapsed is asked of a last stage in motion, "
      "a "
      "rest until all is still follows it in every trial.\n\n" +
      default_criteria() +
      "\n"
      "Examples:\n"
      "  keyblock limit tunnel.toml --key joints.friction --from 45 --to 5 -o out/friction\n"
      "  keyblock limit tunnel.toml --key joints.strength_factor --from 0.5 --to 5 -o out/safety\n"
      "  keyblock limit tunnel.toml --key excavation.tunnel.pressure --from 2e5 --to 0 --until fallen "
      "--above 0.1 "
      "-o out/pressure\n"
      "  keyblock limit slope.toml --key stage.excavated.k_h --from 0 --to -0.5 -o out/yield\n"
      "  keyblock limit arch.toml --key tilt --from 0 --to 45 -o out/tilt");
  command->callback([arguments] { run_limit(*arguments); });
}

}  // namespace keyblock::app
