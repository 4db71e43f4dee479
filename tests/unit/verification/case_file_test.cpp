#include "verification/case_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../fresh_folder.h"
#include "verification/simulate.h"

namespace keyblock::verification {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class CaseFileTest : public ::testing::Test {
 protected:
  CaseFileTest() { write("s.toml", ""); }

  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  CaseFile read(const std::string& runs) {
    return read_case(write("case.toml", "title = \"T\"\ncase = 4\n" + runs));
  }
  /// The mistakes of a case, one a line.
  std::string mistakes(const std::string& runs) {
    try {
      read(runs);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  const FreshFolder folder_;
};

const std::string run = "[[run]]\nname = \"r\"\nscenario = \"s.toml\"\n";
const std::string quantity = "[[run.quantity]]\nname = \"q\"\nvalue = \"1\"\nexpected = 1\ntolerance = 0.1\n";

TEST_F(CaseFileTest, GridOfSimulations) {
  const CaseFile file =
      read(run +
           "orders = [1, 3]\nset = [\"a.b=1\"]\nvary = { \"time.step\" = [0.1, 0.2] }\n[run.points]\nkeys = "
           "[\"gravity\", \"joints.friction\"]\nlabels = [\"steep\", \"flat\"]\nvalues = [[[1.0, 2.0], 3.0], "
           "[[4.0, 5.0], 6.0]]\n" +
           quantity);
  EXPECT_EQ(file.name, "case");
  EXPECT_EQ(file.number, 4);
  const auto all = simulations(file.runs.at(0));
  ASSERT_EQ(all.size(), 8u);
  EXPECT_THAT(all[0].overrides, ElementsAre("a.b=1", "rock.order=1", "gravity=[1.0, 2.0]",
                                            "joints.friction=3.0", "time.step=0.1"));
  EXPECT_EQ(all[0].label, "steep, time.step = 0.1");
  EXPECT_EQ(all[3].label, "flat, time.step = 0.2");
  EXPECT_EQ(all[3].point, 1u);
  EXPECT_EQ(all[4].order, 3);
}

TEST_F(CaseFileTest, ARunAloneIsOneSimulation) {
  EXPECT_EQ(simulations(read(run + quantity).runs.at(0)).size(), 1u);
}

TEST_F(CaseFileTest, MistakesHaveTheirPlace) {
  EXPECT_THAT(
      mistakes(run + "[[run.quantity]]\nname = \"q\"\nvalue = \"1 +\"\nexpected = 1\ntolerance = 0.1\n"),
      HasSubstr("case.toml:8:9: run.r.quantity.q.value: found the end at character 4 of the expression; "
                "expected a number, a function or '('"));
  EXPECT_THAT(mistakes(run + quantity + "tolerence = 1\n"), HasSubstr("did you mean 'tolerance'?"));
  EXPECT_THAT(mistakes("[[run]]\nname = \"r\"\nscenario = \"t.toml\"\n" + quantity),
              HasSubstr("run.r.scenario: found the string \"t.toml\"; expected a file that exists"));
}

TEST_F(CaseFileTest, WhatIsExpectedMustBeSaidOnce) {
  const std::string start = run + "[[run.quantity]]\nname = \"q\"\nvalue = 1\n";
  EXPECT_THAT(mistakes(start), HasSubstr("found nothing; expected one of expected, expected_by_order"));
  EXPECT_THAT(mistakes(start + "expected = 1\nat_most = 2\n"), HasSubstr("found several of them"));
  EXPECT_THAT(mistakes(start + "expected = 1\n"), HasSubstr("either tolerance or absolute_tolerance"));
  EXPECT_THAT(mistakes(start + "at_most = 1\ntolerance = 1\n"), HasSubstr("a tolerance beside a bound"));
  EXPECT_EQ(mistakes(start + "at_most = 1\n"), "");
}

TEST_F(CaseFileTest, ListsHaveTheirLength) {
  EXPECT_THAT(mistakes(run + "orders = [1, 2]\n" + quantity + "published_by_order = [1]\n"),
              HasSubstr("expected an array of 2 numbers, one for each of the orders"));
  EXPECT_THAT(mistakes(run + quantity + "published_by_order = [1]\n"),
              HasSubstr("only with orders of the run"));
  EXPECT_THAT(mistakes(run + "[run.points]\nkeys = [\"a\"]\nvalues = [[1, 2]]\n" + quantity),
              HasSubstr("expected an array of 1, a value for each key"));
  EXPECT_THAT(
      mistakes(run + "[run.points]\nkeys = [\"a\"]\nlabels = [\"x\", \"y\"]\nvalues = [[1]]\n" + quantity),
      HasSubstr("one for each of the 1 values"));
  EXPECT_THAT(mistakes(run + "orders = [0]\n" + quantity), HasSubstr("an array of integers from 1 to 24"));
}

TEST_F(CaseFileTest, BuiltInChecksHaveNoScenario) {
  EXPECT_THAT(mistakes("[[run]]\nname = \"r\"\nbuiltin = \"polygon_integral\"\n" + quantity),
              HasSubstr("did you mean 'polygon_integrals'?"));
  EXPECT_THAT(mistakes(run + "builtin = \"polygon_integrals\"\n" + quantity),
              HasSubstr("only with a scenario"));
  EXPECT_THAT(
      mistakes("[[run]]\nname = \"r\"\nbuiltin = \"trace_topology\"\ndata = [\"gone.json\"]\n" + quantity),
      HasSubstr("found \"gone.json\"; expected a file that exists"));
  EXPECT_THAT(mistakes(run + "realizations = 4\n" + quantity), HasSubstr("only with command = \"cut\""));
}

TEST_F(CaseFileTest, AFolderWithoutCases) {
  EXPECT_THROW(read_cases(folder_ / "gone"), InputError);
  std::filesystem::create_directories(folder_ / "empty");
  EXPECT_THROW(read_cases(folder_ / "empty"), InputError);
}

}  // namespace
}  // namespace keyblock::verification
