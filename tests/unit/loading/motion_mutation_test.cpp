#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "../fresh_folder.h"
#include "motion_texts.h"

// Damaged files. Each is read, with every number finite, or refused with a message that has the file, what was found and what is
// expected. Lines that are lost, doubled or cut off never change what is read without an error or a note. The environment variable
// KEYBLOCK_MUTATIONS multiplies the number of mutations.
namespace keyblock::loading {
namespace {

using Components = std::vector<MotionComponent>;

enum class Damage { truncated, line_lost, line_doubled, lines_swapped, byte_changed, byte_inserted };

struct Line {
  std::size_t begin, end;  // with its line end
};

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string damaged(const std::string& text, Damage damage) {
    std::string out = text;
    const Line line = any_line(text), other = any_line(text);
    const std::string words = text.substr(line.begin, line.end - line.begin);
    switch (damage) {
      case Damage::truncated:
        return text.substr(0, number(text.size()));
      case Damage::line_lost:
        return out.erase(line.begin, words.size());
      case Damage::line_doubled:
        return out.insert(line.begin, words);
      case Damage::lines_swapped:
        if (line.end > other.begin) return out;
        out.replace(other.begin, other.end - other.begin, words);
        return out.replace(line.begin, words.size(), text.substr(other.begin, other.end - other.begin));
      case Damage::byte_changed:
        out[number(text.size())] = any_byte();
        return out;
      case Damage::byte_inserted:
        return out.insert(number(text.size()), 1, any_byte());
    }
    return out;
  }

 private:
  std::size_t number(std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random_);
  }

  Line any_line(const std::string& text) {
    const std::size_t at = number(text.size());
    const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const std::size_t after = text.find('\n', at);
    return {before == std::string::npos ? 0 : before + 1,
            after == std::string::npos ? text.size() : after + 1};
  }

  char any_byte() {
    constexpr std::string_view likely = "0123456789.,;-+eEdD \t\n#/()=:gms";
    return number(3) > 0 ? likely[number(likely.size())] : static_cast<char>(number(256));
  }

  std::mt19937 random_;
};

class MotionMutation : public testing::Test {
 protected:
  // What is read; empty when the file is refused.
  Components read(const std::string& text) {
    std::ofstream(folder_ / "record", std::ios::binary) << text;
    try {
      return read_motion_file(folder_ / "record");
    } catch (const InputError& error) {
      for (const Diagnostic& d : error.diagnostics()) {
        EXPECT_FALSE(d.where.file.empty());
        EXPECT_FALSE(d.found.empty());
        EXPECT_FALSE(d.expected.empty());
      }
      return {};
    }
  }

 private:
  FreshFolder folder_;
};

void expect_sound(const Components& components) {
  for (const MotionComponent& c : components) {
    ASSERT_FALSE(c.acceleration.empty());
    EXPECT_TRUE(c.times.empty() || c.times.size() == c.acceleration.size());
    EXPECT_TRUE(std::is_sorted(c.times.begin(), c.times.end()));
    EXPECT_TRUE(!c.times.empty() || c.dt > 0.0);
    EXPECT_TRUE(std::isfinite(c.end()));
    for (const double a : c.acceleration) ASSERT_TRUE(std::isfinite(a));
  }
}

bool same(const MotionComponent& a, const MotionComponent& b) {
  return a.acceleration == b.acceleration && a.dt == b.dt && a.start == b.start && a.times == b.times;
}

// Components of `read` that `whole` has not, and that come without a note.
std::size_t silent_differences(const Components& whole, const Components& read) {
  return static_cast<std::size_t>(std::count_if(read.begin(), read.end(), [&](const MotionComponent& c) {
    const bool known =
        std::any_of(whole.begin(), whole.end(), [&](const MotionComponent& w) { return same(w, c); });
    return !known && c.notes.empty();
  }));
}

int mutations() {
  const char* factor = std::getenv("KEYBLOCK_MUTATIONS");  // NOLINT(concurrency-mt-unsafe)
  constexpr int usual = 25;
  return usual * (factor == nullptr ? 1 : std::max(1, std::atoi(factor)));
}

TEST_F(MotionMutation, IsReadWholeOrRefusedOrTold) {
  unsigned seed = 1;
  int refused = 0, accepted = 0;
  for (const auto& [name, text] : motion_corpus()) {
    const Components whole = read(text);
    ASSERT_FALSE(whole.empty()) << name;
    const bool counted = whole[0].format != "table";
    for (const Damage damage : {Damage::truncated, Damage::line_lost, Damage::line_doubled,
                                Damage::lines_swapped, Damage::byte_changed, Damage::byte_inserted}) {
      Mutator mutator(++seed);
      const bool lines = damage <= Damage::line_doubled;
      for (int k = 0; k < mutations(); ++k) {
        const std::string mutated = mutator.damaged(text, damage);
        SCOPED_TRACE(fmt::format("{}, damage {}, number {}", name, static_cast<int>(damage), k));
        const Components components = read(mutated);
        expect_sound(components);
        ++(components.empty() ? refused : accepted);
        // Whole numbers that are cut off are numbers still, but they are the last ones.
        const bool in_last_count = whole[0].format.starts_with("K") && mutated.size() + 8 > text.size();
        if (!lines || !counted || in_last_count || silent_differences(whole, components) == 0) continue;
        FAIL() << "read as something else:\n" << mutated;
      }
    }
  }
  // The damage is not so large that all is refused, and not so small that nothing is.
  EXPECT_GT(refused, 500);
  EXPECT_GT(accepted, 500);
}

}  // namespace
}  // namespace keyblock::loading
