#include <gtest/gtest.h>

#include <cstdlib>

#include "core/atomic_file.h"
#include "scenario/key_reference.h"

// With KEYBLOCK_UPDATE_EXPECTED set, docs/scenario.md is written instead of compared.

namespace keyblock::scenario {
namespace {

const std::filesystem::path page = std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "docs/scenario.md";
const std::string begin_mark =
    "<!-- What follows is written by the program: see tests/unit/scenario/reference_test.cpp -->\n";

const SectionReference* find_section(const std::vector<SectionReference>& sections,
                                     const std::string& title) {
  for (const SectionReference& section : sections) {
    if (section.title == title) return &section;
  }
  return nullptr;
}

const KeyReference* find_key(const SectionReference& section, const std::string& key) {
  for (const KeyReference& known : section.keys) {
    if (known.key == key) return &known;
  }
  return nullptr;
}

TEST(Reference, HasEverySection) {
  const auto sections = key_reference();
  for (const char* title : {"",
                            "[section]",
                            "[domain]",
                            "[rock]",
                            "[joints]",
                            "[[joint_set]]",
                            "[[trace_map]]",
                            "[[region]]",
                            "[[excavation]]",
                            "[[block]]",
                            "[in_situ]",
                            "[[motion]]",
                            "[[load]]",
                            "[[support]]",
                            "[[stage]]",
                            "[time]",
                            "[[history]]",
                            "[damage]",
                            "[output]",
                            "[solver]",
                            "[study]",
                            "[cutting]",
                            "Distribution",
                            "Sine or file"}) {
    EXPECT_NE(find_section(sections, title), nullptr) << title;
  }
}

TEST(Reference, EverySectionAndKeyHasAMeaning) {
  for (const SectionReference& section : key_reference()) {
    EXPECT_NE(section.meaning, "") << section.title;
    EXPECT_FALSE(section.keys.empty()) << section.title;
    for (const KeyReference& key : section.keys) {
      EXPECT_NE(key.meaning, "") << section.title << " " << key.key;
      EXPECT_NE(key.type, "") << section.title << " " << key.key;
      EXPECT_NE(key.fallback, "") << section.title << " " << key.key;
    }
  }
}

TEST(Reference, KeysAreDescribedOnce) {
  for (const SectionReference& section : key_reference()) {
    for (const KeyReference& key : section.keys) {
      EXPECT_EQ(find_key(section, key.key), &key) << section.title << " " << key.key;
    }
  }
}

TEST(Reference, DefaultsTypesUnitsAndConditions) {
  const auto sections = key_reference();
  const KeyReference* density = find_key(*find_section(sections, "[rock]"), "density");
  ASSERT_NE(density, nullptr);
  EXPECT_EQ(density->type, "number above 0");
  EXPECT_EQ(density->fallback, "required");
  EXPECT_EQ(density->unit, "kg/m³");
  const KeyReference* state = find_key(*find_section(sections, "[rock]"), "state");
  EXPECT_EQ(state->type, "\"plane-stress\" or \"plane-strain\"");
  EXPECT_EQ(state->fallback, "\"plane-stress\"");
  const KeyReference* motion = find_key(*find_section(sections, "[[stage]]"), "motion");
  EXPECT_EQ(motion->meaning,
            "The ground motion; of a suite its name, for its first record, or `SUITE/RECORD`. Only with kind "
            "= \"shake\".");
  EXPECT_NE(find_key(*find_section(sections, "[[motion]]"), "components.file"), nullptr);
}

TEST(Reference, ThePageOfTheGuideIsUpToDate) {
  const std::string text = read_file(page);
  const std::size_t begin = text.find(begin_mark);
  ASSERT_NE(begin, std::string::npos);
  const std::string head = text.substr(0, begin + begin_mark.size());
  const std::string expected = head + "\n" + scenario_reference();
  if (std::getenv("KEYBLOCK_UPDATE_EXPECTED") != nullptr) {
    write_file_atomically(page, expected);
    return;
  }
  EXPECT_EQ(text, expected) << "run this test with KEYBLOCK_UPDATE_EXPECTED=1 set and commit " << page;
}

}  // namespace
}  // namespace keyblock::scenario
