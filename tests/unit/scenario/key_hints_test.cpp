#include "scenario/key_hints.h"

#include <gtest/gtest.h>

#include <set>

#include "scenario/key_reference.h"
#include "scenario/synonyms.h"
#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

// What a message says after what was expected; empty: no hint.
std::string hint_of(const std::string& override_) {
  const std::string text = mistakes(runnable_domain, {override_});
  for (const std::string& line : {text.substr(0, text.find('\n'))}) {
    const std::size_t expected = line.find("; expected ");
    const std::size_t end = expected == std::string::npos ? expected : line.find("; ", expected + 2);
    if (end != std::string::npos) return line.substr(end + 2);
  }
  return {};
}

struct Case {
  const char *override_, *hint;
};

void expect_hints(std::initializer_list<Case> cases) {
  for (const Case& c : cases) EXPECT_EQ(hint_of(c.override_), c.hint) << c.override_;
}

TEST(KeyHints, OfWordsOfOtherPrograms) {
  expect_hints({{"rock.E=1", "did you mean 'young'?"},
                {"rock.nu=1", "did you mean 'poisson'?"},
                {"rock.dens=1", "did you mean 'density'?"},
                {"time.dt=1", "did you mean 'step'?"},
                {"joints.phi=1", "did you mean 'friction'?"},
                {"joints.friction_angle=1", "did you mean 'friction'?"},
                {"joints.jkn=1", "did you mean 'normal_stiffness'?"},
                {"joints.ks=1", "did you mean 'shear_stiffness'?"},
                {"joints.tens=1", "did you mean 'tension'?"},
                {"joints.stiffness=1", "did you mean 'normal_stiffness'?"},
                {"joint_set.bedding.azimuth=1", "did you mean 'dip_direction'?"},
                {"jset=1", "did you mean 'joint_set'?"},
                {"fault=1", "did you mean 'trace_map'?"},
                {"earthquake=1", "did you mean 'motion'?"},
                {"rockbolts=1", "did you mean 'bolt'?"},
                {"anchor=1", "did you mean 'bolt'?"},
                {"excavation.tunnel.height=1", "did you mean 'wall_height'?"},
                {"excavation.tunnel.radius=1", "did you mean 'diameter'?"},
                {"excavation.tunnel.internal_pressure=1", "did you mean 'pressure'?"},
                {"stage.settled.relax=0.5", "did you mean 'release'?"},
                {"stage.settled.kind=static", "did you mean 'settle'?"},
                {"stage.settled.kind=earthquake", "did you mean 'shake'?"},
                {"excavation.tunnel.shape=arch", "did you mean 'horseshoe'?"}});
}

TEST(KeyHints, OfKeysThatBelongElsewhere) {
  expect_hints(
      {{"rock.kn=1",
        "'normal_stiffness' belongs to [joints], [[joint_set]], [[trace_map]], [rock_bridge], [[interface]], "
        "[[liner]]"},
       {"rock.dt=1", "'step' belongs to [time]"},
       {"E=1", "'young' belongs to [rock], [[region]], [[block]], [[block_map]], [[bolt]], [[liner]]"},
       {"rock.units=1", "'units' belongs to the top of the file"},
       {"K0=1", "'k0' belongs to [in_situ]"},
       {"rock.fault=1", "[[trace_map]] is the table for that"},
       {"joints.dipp=1", "'dip' belongs to [[joint_set]]"}});
}

TEST(KeyHints, OfWhatTheProgramHasNot) {
  expect_hints(
      {{"srf=1",
        "strength_factor of [joints] divides their strength; keyblock limit finds the factor of "
        "safety by --key "
        "joints.strength_factor"},
       {"steelset=1", "steel sets are not in the program; [[liner]] is shotcrete"},
       {"lining=1", "did you mean 'liner'?"},
       {"flow=1", "flow of water in joints is not in the program; [water] is water at rest, below a table"},
       {"groundwater=1", "did you mean 'water'?"},
       {"joints.dilation=1", "dilation of joints is not in the program"}});
}

TEST(KeyHints, NoneRatherThanAWrongOne) {
  expect_hints({{"rock.name=x", ""},  // a key of half of all tables
                {"load=[{excavation='tunnel'}]", ""},
                {"rock.what=1", ""},
                {"rock.kg=1", ""},
                {"in_situ.szz=1", ""},
                {"motion=[{name='m', depth_of=1}]", ""}});
}

// Each key stands somewhere: a table that is renamed takes its synonyms along. And no word has two meanings.
TEST(KeyHints, SynonymsAreOfThisProgram) {
  std::set<std::string, std::less<>> here{"rock",
                                          "settle",
                                          "rest",
                                          "shake",
                                          "polygon",
                                          "circle",
                                          "horseshoe",
                                          "frame",
                                          "normal",
                                          "exponential",
                                          "average-acceleration"};
  for (const SectionReference& section : key_reference()) {
    const std::size_t begin = section.title.find_first_not_of('[');
    if (begin != std::string::npos) here.insert(section.title.substr(begin, section.title.find(']') - begin));
    for (const KeyReference& key : section.keys) here.insert(key.key);
  }
  const auto each = [](std::string_view text, const auto& what) {
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find(' ', begin), text.size());
      what(text.substr(begin, end - begin));
      begin = end + 1;
    }
  };
  for (const Synonym& synonym : synonyms())
    each(synonym.keys, [&](std::string_view key) { EXPECT_TRUE(here.contains(key)) << key; });
  std::set<std::string_view> explained;
  for (const Explanation& explanation : explanations())
    each(explanation.words,
         [&](std::string_view word) { EXPECT_TRUE(explained.insert(word).second) << word; });
  for (const Synonym& synonym : synonyms())
    each(synonym.words, [&](std::string_view word) { EXPECT_FALSE(explained.contains(word)) << word; });
}

}  // namespace
}  // namespace keyblock::scenario
