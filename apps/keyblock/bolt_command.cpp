#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "core/error.h"
#include "core/file_set.h"
#include "core/read_file.h"
#include "core/svg.h"
#include "job/result_folder.h"
#include "loading/motion_text.h"
#include "loading/svg_chart.h"
#include "loading/text_table.h"
#include "scenario_arguments.h"
#include "simulation/bolt_bench.h"

namespace keyblock::app {
namespace {

constexpr double millimetre = 1e-3, kilonewton = 1e3;

struct BoltArguments {
  ScenarioArguments scenario;
  std::string name, folder;
  std::optional<double> at;
  double way = 20.0;                    ///< mm
  std::array<std::string, 2> measured;  ///< files: pull, shear
};

/// One of the two tests.
struct Test {
  const char* name;
  simulation::BoltCurve curve;
  std::vector<double> displacement, force;  ///< measured, m and N; empty: none
};

[[noreturn]] void refuse_bolt(std::string key, std::string found, std::string expected) {
  Diagnostic mistake;
  mistake.key = std::move(key);
  mistake.found = std::move(found);
  mistake.expected = std::move(expected);
  throw InputError(std::move(mistake));
}

/// The bolt of a name; one of a pattern stands for all.
loading::Bolt bolt_named(const scenario::Scenario& scenario, const std::string& name) {
  std::string names;
  for (const scenario::BoltSpec& spec : scenario.bolts) {
    if (spec.bolt.list != name) {
      names += (names.empty() ? "" : ", ") + spec.bolt.list;
      continue;
    }
    loading::Bolt bolt = spec.bolt;
    if (spec.excavation >= 0) bolt.toe = bolt.head + Vec2{spec.length, 0.0};
    return bolt;
  }
  refuse_bolt("NAME", fmt::format("\"{}\"", name),
              names.empty() ? "a scenario with a [[bolt]]" : "the name of a [[bolt]]: " + names);
}

/// Rows of mm and kN; a first line may have names.
void read_measured(const std::string& file, Test& test) {
  if (file.empty()) return;
  const loading::MotionText text(file, read_file(file));
  std::size_t first = 0;
  while (first < text.size() &&
         (loading::is_comment(text.line(first)) || (first == 0 && !loading::row_separator(text.line(first)))))
    ++first;
  const loading::TextTable table = loading::read_rows(text, first);
  if (table.columns.size() != 2)
    text.refuse(fmt::format("{} columns", table.columns.size()),
                "two columns: displacement in mm, force in kN");
  for (std::size_t k = 0; k < table.lines.size(); ++k) {
    if (k > 0 && !(table.columns[0][k] > table.columns[0][k - 1]))
      text.fail(table.lines[k], "a displacement larger than that of the row before");
    test.displacement.push_back(table.columns[0][k] * millimetre);
    test.force.push_back(table.columns[1][k] * kilonewton);
  }
}

std::string as_csv(const simulation::BoltCurve& curve) {
  std::string csv = "displacement_mm,force_kn\n";
  for (std::size_t k = 0; k < curve.force.size(); ++k)
    csv += fmt::format("{:.9g},{:.9g}\n", curve.displacement[k] / millimetre, curve.force[k] / kilonewton);
  return csv;
}

std::vector<double> scaled(const std::vector<double>& values, double unit) {
  std::vector<double> all;
  for (const double value : values) all.push_back(value / unit);
  return all;
}

double largest_of(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::ranges::max_element(values);
}

std::string as_svg(const std::string& title, const std::vector<Test>& tests) {
  constexpr double width = 900.0, height = 330.0, edge = 80.0, panel = 230.0;
  std::string svg = svg_begin(width, height * static_cast<double>(tests.size()), 12);
  double top = 50.0;
  for (const Test& test : tests) {
    loading::ChartFrame frame{edge, top, width - 2.0 * edge, panel, {}, {}};
    frame.x = {0.0, std::max(test.curve.displacement.back(), largest_of(test.displacement)) / millimetre};
    frame.y = {0.0, 1.08 * std::max({test.curve.largest(), largest_of(test.force), 1.0}) / kilonewton};
    svg += loading::draw_frame(frame, fmt::format("{}: {}, kN over mm", title, test.name), true);
    if (!test.force.empty())
      svg += loading::draw_curve(frame, scaled(test.displacement, millimetre), scaled(test.force, kilonewton),
                                 "#D55E00", 1.5);
    svg += loading::draw_curve(frame, scaled(test.curve.displacement, millimetre),
                               scaled(test.curve.force, kilonewton), "#222222", 1.5);
    if (!test.force.empty()) svg += svg_text(width - edge, top - 7.0, "end", "measured", "fill=\"#D55E00\"");
    top += height;
  }
  return svg.append(svg_end);
}

/// The largest force, and how far that of the program is from what was measured.
std::string told(const Test& test) {
  const simulation::BoltCurve& curve = test.curve;
  const double most = curve.largest();
  if (most <= 0.0) return fmt::format("{:<6} the bolt does nothing\n", test.name);
  const auto share = [&](double part) {
    const auto reached = std::ranges::find_if(curve.force, [&](double f) { return f >= part * most; });
    return curve.displacement[static_cast<std::size_t>(reached - curve.force.begin())] / millimetre;
  };
  std::string text = fmt::format("{:<6} {:.4g} kN at the most; half of it at {:.3g} mm, 99 % at {:.3g} mm\n",
                                 test.name, most / kilonewton, share(0.5), share(0.99));
  if (test.force.empty()) return text;
  double squares = 0.0, largest = 0.0, where = 0.0;
  for (std::size_t k = 0; k < test.force.size(); ++k) {
    const double off = curve.force_at(test.displacement[k]) - test.force[k];
    squares += off * off;
    if (std::abs(off) <= std::abs(largest)) continue;
    largest = off;
    where = test.displacement[k];
  }
  return text + fmt::format(
                    "       measured {:.4g} kN at the most; the program is {:.3g} kN off on the root mean "
                    "square, most at {:.3g} mm: {:+.3g} kN\n",
                    largest_of(test.force) / kilonewton,
                    std::sqrt(squares / static_cast<double>(test.force.size())) / kilonewton,
                    where / millimetre, largest / kilonewton);
}

void test_bolts(const BoltArguments& arguments) {
  const scenario::Scenario scenario = arguments.scenario.read();
  const loading::Bolt bolt = bolt_named(scenario, arguments.name);
  job::check_holds_no_run(arguments.folder);
  std::vector<Test> tests{{"pull", {}, {}, {}}, {"shear", {}, {}, {}}};
  for (std::size_t k = 0; k < tests.size(); ++k) {
    read_measured(arguments.measured[k], tests[k]);
    const double way = std::max(arguments.way * millimetre, largest_of(tests[k].displacement));
    tests[k].curve = simulation::test_bolt(
        bolt, {.at = arguments.at.value_or(0.5 * bolt.length()), .way = way, .is_shear = k == 1});
  }
  FileSet out(arguments.folder);
  for (const Test& test : tests) {
    out.write(std::string(test.name) + ".csv", as_csv(test.curve));
    std::cout << told(test);
  }
  out.write("bolt.svg", as_svg(arguments.name, tests));
  out.commit();
  std::cout << "curves: " << arguments.folder << "\n";
}

}  // namespace

void add_bolt(CLI::App& app) {
  auto arguments = std::make_shared<BoltArguments>();
  CLI::App* command = app.add_subcommand("bolt", "Pull-out and shear curves of a bolt, beside measured ones");
  add_scenario_file(*command, arguments->scenario);
  command->add_option("NAME", arguments->name, "Name of the [[bolt]]")->required();
  command->add_option("-o,--output", arguments->folder, "Folder of pull.csv, shear.csv and bolt.svg")
      ->required()
      ->type_name("DIR");
  command->add_option("--at", arguments->at, "Where the joint is, in m from the head; default the middle")
      ->type_name("M");
  command->add_option("--way", arguments->way, "How far the joint is moved, in mm")
      ->check(CLI::Range(1e-3, 1e4).description(""))
      ->type_name("MM")
      ->capture_default_str();
  command
      ->add_option("--pull", arguments->measured[0],
                   "A measured pull-out curve: rows of displacement in mm and force in kN of one bolt")
      ->type_name("CSV");
  command->add_option("--shear", arguments->measured[1], "The same of shear")->type_name("CSV");
  command->footer(
      "The joint has no friction. Pretension is left out.\n\n"
      "Examples:\n  keyblock bolt tunnel.toml crown -o out/bolt\n"
      "  keyblock bolt tunnel.toml crown --pull test.csv --set bolt.crown.grout_stiffness=5e9 -o out/bolt");
  command->callback([arguments] { test_bolts(*arguments); });
}

}  // namespace keyblock::app
