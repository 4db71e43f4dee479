#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "scenario/build.h"
#include "scenario/inputs.h"
#include "scenario_text.h"
#include "simulation/build_model.h"

namespace keyblock::scenario {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A value of any kind, of those that are at an edge of something.
Value odd_value(std::mt19937_64& random) {
  static const Value pool = parse_toml(
      "v = [0, 1, -1, 0.0, -0.5, 1e-300, 1e300, 90, 89.999, 0.5, 360, 361, 24, 1.5, true, '', 'auto', 'x', "
      "'frame', 'still', "
      "'nope', [], [1], [1, 2], [2, 1], [1.0, 2.0, 3.0], {}, {mean = 1.0}, [[0, 0], [1, 1]], [[1, 0], [0, "
      "1]], 'up', inf, "
      "nan, 9007199254740993, 10001, 1979-01-01, [{}], [1, {name = 'E1'}]]",
      "pool");
  const std::vector<Value>& values = pool.items.front().items;
  return values[random() % values.size()];
}

/// A value of the document, each as likely as the other.
Value* any_value(Value& document, std::mt19937_64& random) {
  std::vector<Value*> all, open{&document};
  while (!open.empty()) {
    Value* value = open.back();
    open.pop_back();
    for (Value& item : value->items) {
      all.push_back(&item);
      open.push_back(&item);
    }
  }
  return all.empty() ? nullptr : all[random() % all.size()];
}

void put(Value value, Value& place) {
  value.key = place.key;
  value.key_where = place.key_where;
  value.where = place.where;
  place = std::move(value);
}

void mutate(Value& document, std::mt19937_64& random) {
  Value* place = any_value(document, random);
  if (place == nullptr) return;
  switch (random() % 5) {
    case 0: {  // one less
      if (!place->items.empty())
        place->items.erase(place->items.begin() + static_cast<long>(random() % place->items.size()));
      break;
    }
    case 1: {  // one more, before the others or after
      Value more = odd_value(random);
      more.key = "foo";
      place->items.insert(random() % 2 == 0 ? place->items.begin() : place->items.end(), std::move(more));
      break;
    }
    case 2: {
      Value list;
      list.type = Value::Type::array;
      list.items = {*place};
      put(list, *place);
      break;
    }
    default:
      put(odd_value(random), *place);
  }
}

/// A scenario is built, or refused with a reason.
void expect_word(const std::string& text, const fs::path& file, int tries, bool builds) {
  std::mt19937_64 random(text.size());
  for (int k = 0; k < tries; ++k) {
    Value document = parse_toml(text, file.string());
    const std::uint64_t count = 1 + random() % 2;
    for (std::uint64_t n = 0; n < count; ++n) mutate(document, random);
    const std::string mutated = to_toml(document);
    try {
      const Scenario scenario = parse_document(document, file, mutated);
      std::vector<std::string> warnings = plausibility_warnings(scenario);
      if (builds && !scenario.stages.empty()) simulation::build_model(build_setup(scenario, 0, &warnings));
    } catch (const InputError& error) {
      for (const Diagnostic& mistake : error.diagnostics()) EXPECT_FALSE(mistake.expected.empty()) << mutated;
    } catch (const RunError&) {
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what() << " of\n" << mutated;
      return;
    }
  }
}

TEST(MutatedScenarios, OfTemplatesAreReadOrRefused) {
  int files = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(KEYBLOCK_SOURCE_DIR) / "apps/keyblock/templates")) {
    if (entry.path().extension() != ".toml") continue;
    ++files;
    expect_word(text_of(entry.path()), entry.path(), 400, false);
  }
  EXPECT_GE(files, 7);
}

TEST(MutatedScenarios, OfFewBlocksAreBuiltOrRefused) {
  const std::string with_all = two_blocks + R"(
[[motion]]
name = "m"
x = { amplitude = 1.0, frequency = 2.0, cycles = 2 }
pga = 2.0
[[load]]
block = "top"
from = [3, 1]
to = [3, 2]
traction = [-1e4, 0]
[[spring]]
name = "K1"
from = [2, 0.9]
to = [2, 1.1]
stiffness = 1e7
yield = 1e5
[[history]]
name = "h"
block = "top"
point = [2, 1.5]
[[stage]]
name = "shaken"
kind = "shake"
motion = "m"
install = ["K1"]
[study]
[[study.vary]]
key = "motion.m.pga"
values = [1.0, 2.0]
)";
  expect_word(with_all, "/nowhere/blocks.toml", 1500, true);
}

TEST(MutatedScenarios, OfACutDomainAreBuiltOrRefused) {
  expect_word(runnable_domain, "/nowhere/domain.toml", 100, true);
}

}  // namespace
}  // namespace keyblock::scenario
