#include "verification/rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "verification/report.h"

namespace keyblock::verification {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Formula formula(const std::string& text) {
  return {Expression(text), {"case.toml", 7, 9}, "run.r.quantity.q.value"};
}

/// A run with two simulations, histories of a falling point, and quantities to be added.
struct Case {
  RunSpec spec;
  SolvedRun run;
  CaseFile file;

  Case() {
    spec.name = "r";
    run.spec = &spec;
    for (const double friction : {10.0, 20.0}) {
      Simulation simulation;
      simulation.overrides = {"gravity=[1.5, 2.5]", "joints.friction=" + std::to_string(friction)};
      simulation.parameters = {{"joints.friction", std::to_string(friction)}};
      simulation.label = "φ < " + std::to_string(static_cast<int>(friction));
      simulation.point = run.simulations.size();
      run.simulations.push_back(simulation);
      Outcome outcome;
      outcome.order = 2;
      outcome.columns = {"time", "s.ux", "s.uy"};
      for (int k = 0; k <= 40; ++k) {
        const double t = 0.1 * k;
        outcome.rows.push_back({t, friction * t, std::sin(2.0 * std::acos(-1.0) * t)});
      }
      outcome.stage_rows = {{"first", 11}, {"second", 41}};
      outcome.summary = {{"energy.kinetic", 3.0}};
      outcome.forces = {{{"a", "b"}, {5.0, 4.0}}};
      run.outcomes.push_back(std::move(outcome));
    }
  }
  QuantitySpec& add(const std::string& name, const std::string& value) {
    spec.quantities.emplace_back();
    spec.quantities.back().name = name;
    spec.quantities.back().value = formula(value);
    return spec.quantities.back();
  }
  [[nodiscard]] std::vector<Row> rows() const { return make_rows({run}); }
  double value(const std::string& text) {
    spec.quantities.clear();
    add("q", text).at_most = formula("1e9");
    const Row row = rows().front();
    EXPECT_EQ(row.failure, "");
    return row.computed;
  }
  std::string failure(const std::string& text) {
    spec.quantities.clear();
    add("q", text).at_most = formula("1e9");
    const Row row = rows().front();
    EXPECT_FALSE(row.pass);
    EXPECT_TRUE(std::isnan(row.computed));
    return row.failure;
  }
};

TEST(Rows, QuantitiesOfASimulation) {
  Case c;
  EXPECT_NEAR(c.value("end('s.ux')"), 40.0, 1e-12);
  EXPECT_NEAR(c.value("first('s.ux')"), 0.0, 1e-12);
  EXPECT_NEAR(c.value("at('s.ux', 1.25)"), 12.5, 1e-12);
  EXPECT_NEAR(c.value("after('first', 's.ux')"), 10.0, 1e-12);
  EXPECT_NEAR(c.value("mean('s.ux')"), 20.0, 1e-12);
  EXPECT_NEAR(c.value("crossing('s.ux', 33)"), 3.3, 1e-12);
  EXPECT_NEAR(c.value("period('s.uy')"), 1.0, 1e-3);
  EXPECT_NEAR(c.value("maxabs('s.uy')"), 0.951057, 1e-6);
  EXPECT_NEAR(c.value("min('s.uy')"), -0.951057, 1e-6);
  EXPECT_EQ(c.value("end('time')"), 4.0);
  EXPECT_EQ(c.value("summary('energy.kinetic') + order()"), 5.0);
  EXPECT_EQ(c.value("set('joints.friction')"), 10.0);
  EXPECT_EQ(c.value("set('gravity.1')"), 2.5);
  EXPECT_EQ(c.value("normal_force('b', 'a') - shear_force('a', 'b')"), 1.0);
  EXPECT_EQ(c.value("normal_force('a', 'c')"), 0.0);
}

TEST(Rows, WhatIsNotThereFailsTheRowAndIsNamed) {
  Case c;
  EXPECT_THAT(c.failure("end('s.uz')"),
              HasSubstr("case.toml:7:9: run.r.quantity.q.value: there is no column 's.uz' of histories"));
  EXPECT_THAT(c.failure("at('s.ux', 5)"), HasSubstr("the histories go from 0 to 4 s, not to 5 s"));
  EXPECT_THAT(c.failure("crossing('s.ux', 99)"), HasSubstr("the value 99 is never crossed"));
  EXPECT_THAT(c.failure("period('s.ux')"), HasSubstr("there is no full period"));
  EXPECT_THAT(c.failure("after('third', 's.ux')"), HasSubstr("there is no stage 'third'"));
  EXPECT_THAT(c.failure("summary('energy')"), HasSubstr("there is no number in the summary 'energy'"));
  EXPECT_THAT(c.failure("set('time.step')"), HasSubstr("no override sets 'time.step'"));
  EXPECT_THAT(c.failure("row('before', 'q')"), HasSubstr("there is no run 'before' before this one"));
}

TEST(Rows, TolerancesAndBounds) {
  Case c;
  auto& relative = c.add("relative", "end('s.ux')");
  relative.expected = formula("4.2*set('joints.friction')");
  relative.tolerance = formula("0.05");
  auto& tight = c.add("tight", "end('s.ux')");
  tight.expected = formula("4.2*set('joints.friction')");
  tight.tolerance = formula("0.04");
  auto& absolute = c.add("absolute", "end('s.ux')");
  absolute.expected_by_point = {40.5, 79.0};
  absolute.published_by_point = {41.0, NAN};
  absolute.absolute_tolerance = formula("0.5");
  c.add("most", "end('s.ux')").at_most = formula("40 + 1e-9");
  c.add("least", "end('s.ux')").at_least = formula("40.0001");
  c.add("not a number", "0/0").at_most = formula("1");
  const std::vector<Row> rows = c.rows();
  const std::vector<bool> expected{true, true,  false, false, true,  false,
                                   true, false, false, true,  false, false};
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_EQ(rows[k].pass, expected[k]) << rows[k].quantity << k;
  EXPECT_NEAR(rows[0].relative_error.value(), -0.2 / 4.2, 1e-12);
  EXPECT_EQ(rows[4].published, 41.0);
  EXPECT_FALSE(rows[5].published.has_value());
}

TEST(Rows, WhatIsNotFiniteShowsNothing) {
  Case c;
  for (const char* text : {"1/0", "-1/0", "0/0"}) {
    auto& expected = c.add("expected", "end('s.ux')");
    expected.expected = formula(text);
    expected.tolerance = formula("0.05");
    auto& tolerance = c.add("tolerance", "end('s.ux')");
    tolerance.expected = formula("1");
    tolerance.tolerance = formula(text);
    auto& absolute = c.add("absolute", "end('s.ux')");
    absolute.expected = formula("1");
    absolute.absolute_tolerance = formula(text);
    c.add("most", "end('s.ux')").at_most = formula(text);
    c.add("least", "end('s.ux')").at_least = formula(text);
  }
  for (const Row& row : c.rows()) EXPECT_FALSE(row.pass) << row.quantity;
}

TEST(Rows, OtherRows) {
  Case c;
  c.add("one", "end('s.ux')").at_most = formula("1e9");
  auto& two = c.add("two", "end('s.ux')");
  two.expected = formula("row('r', 'one')");
  two.tolerance = formula("0");
  for (const Row& row : c.rows()) EXPECT_TRUE(row.pass) << row.failure;
}

TEST(Rows, AFailedSimulationFailsItsRows) {
  Case c;
  c.add("one", "end('s.ux')").at_most = formula("1e9");
  c.run.outcomes[1].failure = "no finite state";
  const std::vector<Row> rows = c.rows();
  EXPECT_TRUE(rows[0].pass);
  EXPECT_FALSE(rows[1].pass);
  EXPECT_EQ(rows[1].failure, "no finite state");
}

TEST(Tables, SayWhatDoesNotHold) {
  Case c;
  c.file.name = "slide";
  c.file.number = 4;
  c.file.title = "A <block> & an incline";
  c.file.about = "d = \"½ g t²\"";
  auto& q = c.add("distance", "end('s.ux')");
  q.unit = "m";
  q.expected = formula("40");
  q.tolerance = formula("0.001");
  CaseResult result;
  result.file = &c.file;
  result.rows = c.rows();
  CaseResult left_out;
  left_out.file = &c.file;
  const std::vector<CaseResult> results{result, left_out};
  EXPECT_EQ(result.failed(), 1);

  const std::string text = table_text(results, {false, true});
  EXPECT_THAT(text, HasSubstr("4 slide: A <block> & an incline"));
  EXPECT_THAT(text,
              HasSubstr("distance, m      2  φ < 20            80        40  +100 %      0.1 %  FAIL\n"));
  EXPECT_THAT(text, HasSubstr("1 of 2 rows of 1 cases do not hold\n"));
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  EXPECT_THAT(table_text(results, {true, true}), HasSubstr("\x1b[1;31mFAIL\x1b[0m"));
  EXPECT_THAT(table_text(results, {false, false}), HasSubstr("? < 20"));

  const std::string html = table_html(results, "1.2");
  EXPECT_THAT(html, HasSubstr("A &lt;block&gt; &amp; an incline"));
  EXPECT_THAT(html, HasSubstr("d = &quot;½ g t²&quot;"));
  EXPECT_THAT(html, HasSubstr("φ &lt; 20"));
  EXPECT_THAT(html, HasSubstr("FAIL"));

  const std::string json = table_json(results, "1.2");
  EXPECT_THAT(json, HasSubstr("\"failed\": 1"));
  EXPECT_THAT(json, HasSubstr("\"relative_error\": 1.0"));
  EXPECT_THAT(table_markdown(results, "1.2"), HasSubstr("**FAIL**"));
}

}  // namespace
}  // namespace keyblock::verification
