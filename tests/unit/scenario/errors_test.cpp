#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "core/atomic_file.h"
#include "scenario_text.h"

// Every tests/data/scenario_errors/NAME.toml is wrong; NAME.expected holds all that keyblock has to say about it, one
// diagnostic per line. Lines `# --set key=value` at the top of a file are overrides. With KEYBLOCK_UPDATE_EXPECTED set,
// the expectations are written instead of compared: read them before they are committed.

namespace keyblock::scenario {
namespace {

const std::filesystem::path folder = std::filesystem::path(KEYBLOCK_TEST_DATA) / "scenario_errors";

std::vector<std::string> error_files() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> overrides_of(const std::string& text) {
  const std::string mark = "# --set ";
  std::vector<std::string> overrides;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line) && line.starts_with(mark);) {
    overrides.push_back(line.substr(mark.size()));
  }
  return overrides;
}

std::string without_folder(std::string text) {
  const std::string prefix = folder.string() + "/";
  for (auto found = text.find(prefix); found != std::string::npos; found = text.find(prefix)) {
    text.erase(found, prefix.size());
  }
  return text;
}

class ScenarioErrors : public testing::TestWithParam<std::string> {};

TEST_P(ScenarioErrors, AreAllReported) {
  const std::filesystem::path file = folder / (GetParam() + ".toml");
  std::string found;
  try {
    parse_scenario(file, overrides_of(read_file(file)));
  } catch (const InputError& error) {
    found = without_folder(error.what()) + "\n";
  }
  ASSERT_NE(found, "") << "no mistake was found";
  const std::filesystem::path expected = folder / (GetParam() + ".expected");
  if (std::getenv("KEYBLOCK_UPDATE_EXPECTED") != nullptr) write_file_atomically(expected, found);
  EXPECT_EQ(found, read_file(expected));
}

INSTANTIATE_TEST_SUITE_P(Files, ScenarioErrors, testing::ValuesIn(error_files()),
                         [](const auto& test) { return test.param; });

TEST(ScenarioErrorFiles, EveryExpectationHasItsScenario) {
  int scenarios = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".expected") {
      EXPECT_TRUE(exists(std::filesystem::path(entry.path()).replace_extension(".toml"))) << entry.path();
    }
    if (entry.path().extension() == ".toml") ++scenarios;
  }
  EXPECT_GE(scenarios, 25);
}

}  // namespace
}  // namespace keyblock::scenario
