#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "core/error.h"
#include "core/text.h"
#include "limit_arguments.h"
#include "scenario/build.h"
#include "scenario/parse.h"
#include "scenario/size_checks.h"
#include "scenario/value.h"

namespace keyblock::app {
namespace {

constexpr double largest_coefficient = 10.0;

/// Keys of [safety] that the command line gives.
struct SafetyArguments {
  LimitArguments limit;
  std::string stage;
  std::vector<std::string> sets;
  std::optional<double> area, moved, from, to;
  bool yield = false;
};

/// Ends of the search: of a factor, or of a seismic coefficient that pushes out of the slope.
void put_ends(const SafetyArguments& arguments, LimitArguments& limit) {
  study::LimitRequest& request = limit.request;
  if (arguments.yield) request.key = study::yield_key;
  const auto checked = [&](const char* option, const std::optional<double>& value) {
    CLI::Range range(arguments.yield ? -largest_coefficient : 1e-3,
                     arguments.yield ? largest_coefficient : 1e3);
    std::string text = fmt::format("{}", value.value_or(1.0));
    if (const std::string mistake = range(text); !mistake.empty())
      throw CLI::ValidationError(option, mistake);
    return value;
  };
  request.from = checked("--from", arguments.from).value_or(arguments.yield ? 0.0 : 0.5);
  const std::optional<double> to = checked("--to", arguments.to);
  if (to || !arguments.yield) {
    request.to = to.value_or(5.0);
    return;
  }
  const scenario::Scenario scenario = scenario::parse_scenario(limit.scenario.file, limit.scenario.overrides);
  const int side = scenario.stages.empty() ? 0 : scenario::side_of_slope(scenario::build_setup(scenario, 0));
  if (side == 0) {
    Diagnostic diagnostic;
    diagnostic.where.file = "--to";
    diagnostic.found = "nothing, and ground that does not fall to one side";
    diagnostic.expected =
        "a coefficient at which the rock moves: above 0 it pushes to the right, below 0 to the left";
    throw InputError(std::move(diagnostic));
  }
  request.to = side;
}

std::string quoted(const std::string& text) {
  scenario::Value value;
  value.type = scenario::Value::Type::string;
  value.text = text;
  return scenario::to_toml(value);
}

void run_safety(const SafetyArguments& arguments) {
  LimitArguments limit = arguments.limit;
  std::vector<std::string>& overrides = limit.scenario.overrides;
  put_ends(arguments, limit);
  if (!arguments.stage.empty()) overrides.push_back("safety.stage=" + quoted(arguments.stage));
  std::string sets;
  for (const std::string& name : arguments.sets) sets += (sets.empty() ? "" : ", ") + quoted(name);
  if (!sets.empty()) overrides.push_back("safety.sets=[" + sets + "]");
  if (arguments.area) overrides.push_back(fmt::format("safety.area={}", *arguments.area));
  if (arguments.moved) overrides.push_back(fmt::format("safety.moved={}", *arguments.moved));
  run_limit(std::move(limit));
}

void add_safety_options(CLI::App& command, SafetyArguments& arguments) {
  study::LimitRequest& request = arguments.limit.request;
  command
      .add_option(
          "--stage", arguments.stage,
          "Stage at whose end strength is reduced; default: stage of [safety], or the last static one")
      ->type_name("STAGE");
  command
      .add_option("--sets", arguments.sets,
                  "Joint sets, trace maps, interfaces, or joints, whose strength is reduced, with commas "
                  "between them; "
                  "default: all")
      ->delimiter(',')
      ->type_name("NAME");
  command.add_option("--area", arguments.area, "So much rock may move, m2; default: none")->type_name("A");
  command
      .add_option("--moved", arguments.moved,
                  "Rock has moved that went farther than this, m; default: 0.2 % of the block size")
      ->type_name("X");
  command.add_flag("--yield", arguments.yield,
                   "The yield coefficient in the place of the factor: the share of its weight that pushes "
                   "each block to the side, "
                   "from the equilibrium on, at which rock moves");
  command
      .add_option("--from", arguments.from,
                  "A factor at which the rock holds; default: 0.5, of the yield coefficient 0")
      ->type_name("A");
  command
      .add_option("--to", arguments.to,
                  "A factor at which it does not; default: 5, of the yield coefficient 1 to the side to "
                  "which the ground falls")
      ->type_name("B");
  command
      .add_option("--tolerance", request.tolerance,
                  "Where the bisection ends: width of the bracket over the larger of its ends")
      ->capture_default_str()
      ->type_name("T");
  command
      .add_option("--sweep", request.scan,
                  "Also look at N equal parts of the way: what moves at which factor, and whether the rock "
                  "holds again")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N");
}

}  // namespace

void add_safety(CLI::App& app) {
  auto arguments = std::make_shared<SafetyArguments>();
  study::LimitRequest& request = arguments->limit.request;
  request.key = study::safety_key;
  request.tolerance = 0.005;
  CLI::App* command = app.add_subcommand("safety",
                                         "Factor of safety, or yield coefficient: what strength of joints "
                                         "may be divided by, or rock be pushed with, from "
                                         "an equilibrium on, until rock moves and "
                                         "falls");
  add_scenario_file(*command, arguments->limit.scenario);
  add_safety_options(*command, *arguments);
  add_limit_realizations(*command, request);
  add_limit_folder(*command, arguments->limit);
  command->add_flag(
      "--resume", arguments->limit.resume,
      "Go on with the runs in DIR; --from, --to, --tolerance, --sweep and --realizations may change");
  command->footer(
      "keyblock limit over safety.strength_factor: every trial ends with a stage in which tan(friction), "
      "cohesion and "
      "tension are divided by the factor: a static one, or with an area one in motion. The answer tells up "
      "to where "
      "the rock holds, from where on it moves, and from where on it falls.\n\n"
      "Examples:\n"
      "  keyblock safety slope.toml -o out/safety\n"
      "  keyblock safety slope.toml --yield -o out/yield\n"
      "  keyblock safety slope.toml --sets bedding --realizations 40 -o out/bedding\n"
      "  keyblock safety tunnel.toml --stage excavated --area 0.5 --sweep 8 -o out/tunnel");
  command->callback([arguments] { run_safety(*arguments); });
}

}  // namespace keyblock::app
