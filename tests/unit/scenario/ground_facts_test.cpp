#include "scenario/ground_facts.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/atomic_file.h"
#include "scenario/parse.h"

namespace keyblock::scenario {
namespace {

const std::filesystem::path gallery = std::filesystem::path(KEYBLOCK_TEST_DATA) / "study/gallery.toml";

std::vector<GroundFact> facts(const std::vector<std::string>& overrides = {}) {
  return ground_facts(parse_scenario_text(read_file(gallery), gallery, overrides));
}

std::string value(const std::vector<GroundFact>& all, const std::string& name) {
  for (const GroundFact& fact : all)
    if (fact.name == name) return fact.value;
  return "none";
}

TEST(GroundFacts, AreWhatAnEngineerAsksFirst) {
  const auto all = facts();
  EXPECT_EQ(value(all, "opening “gallery”"), "circle, 2 m wide, 2 m high");
  EXPECT_EQ(value(all, "stress before excavation"), "of its own weight");
  EXPECT_EQ(value(all, "unit weight γ"), "24.52 kN/m³ (2500 kg/m³)");
  EXPECT_EQ(value(all, "Young's modulus E"), "2 GPa");
  EXPECT_EQ(value(all, "Poisson's ratio ν"), "0.2");
  EXPECT_EQ(value(all, "joints: friction φ"), "30°");
  EXPECT_EQ(value(all, "joints: cohesion c"), "0");
  EXPECT_EQ(value(all, "joints: stiffness"), "kn 40 GPa/m, ks 16 GPa/m (default)");
  EXPECT_EQ(
      value(all, "set “steep”"),
      "dip 75° towards 90° (75° down to the right in the section), spacing 0.9 ± 0.2 m, length 6 ± 1 m");
  EXPECT_EQ(value(all, "set “flat”"),
            "dip 10° towards 270° (10° down to the left in the section), spacing 0.9 ± 0.2 m, length 6 ± 1 "
            "m, φ 25°");
  EXPECT_EQ(value(all, "motion “sine”"), "x: 3 m/s² at 4 Hz, 2 cycles");
}

TEST(GroundFacts, GiveDepthAndStrengthWhereTheyAreGiven) {
  const auto all =
      facts({"in_situ={depth=120, k0=1.2}", "joints.cohesion=5e4", "joints.tension=2.5e6",
             "joints.normal_stiffness=5e8", "rock.state=\"plane-strain\"", "rock.order=\"auto\""});
  EXPECT_EQ(value(all, "depth"), "120 m of rock above the model");
  EXPECT_EQ(value(all, "K₀"), "1.2");
  EXPECT_EQ(value(all, "joints: cohesion c"), "50 kPa");
  EXPECT_EQ(value(all, "joints: tensile strength"), "2.5 MPa");
  EXPECT_EQ(value(all, "joints: stiffness"), "kn 500 MPa/m, ks 200 MPa/m");
  EXPECT_EQ(value(all, "section"), "plane strain, blocks of order automatic");
  EXPECT_EQ(value(facts({"in_situ={sxx=-2e6, syy=-4e6}"}), "stress before excavation"),
            "σxx -2 MPa, σyy -4 MPa, σxy 0 (compression negative)");
}

TEST(GroundFacts, TellWhatBoltsThereAre) {
  const std::string keys = ", diameter=0.025, yield=245e3, grout_stiffness=8e9, grout_strength=4e5";
  EXPECT_EQ(value(facts({"bolt=[{name='crown', excavation='gallery', arc=[30, 150], count=5, length=1.5, "
                         "spacing=1.2, pretension=5e4" +
                         keys + "}]"}),
                  "bolts “crown”"),
            "5 of 1.5 m along “gallery”, grouted, every 1.2 m, yield 245 kN, pretension 50 kN");
  EXPECT_EQ(value(facts({"bolt=[{name='one', from=[0, 1], to=[0, 3], diameter=0.025, kind='anchored'}]"}),
                  "bolts “one”"),
            "one of 2 m from (0, 1), anchored, every 1 m, no yield");
}

TEST(GroundFacts, OfSeveralScenariosHaveAllTheirValues) {
  GroundFacts merged;
  for (const char* friction : {"20", "30", "20"})
    merged.add(facts({std::string("joints.friction=") + friction}));
  EXPECT_EQ(value(merged.merged(), "joints: friction φ"), "20° · 30°");
  EXPECT_EQ(value(merged.merged(), "joints: cohesion c"), "0");
  EXPECT_EQ(merged.merged().size(), facts().size());
  for (int k = 0; k < 4; ++k) merged.add({{"joints: friction φ", std::to_string(31 + k) + "°"}});
  EXPECT_EQ(value(merged.merged(), "joints: friction φ"), "20° … 34° (6 values)");
}

}  // namespace
}  // namespace keyblock::scenario
