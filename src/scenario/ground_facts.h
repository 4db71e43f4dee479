#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace keyblock::scenario {

/// A line of what an engineer asks first of a model: "friction φ", "30°".
struct GroundFact {
  std::string name, value;
  friend bool operator==(const GroundFact&, const GroundFact&) = default;
};

/// The fact that a motion shakes a closed box.
inline constexpr const char* around_the_model = "around the model";

/// The openings, the rock, its joints, and what acts on it: as given, with defaults in their place.
std::vector<GroundFact> ground_facts(const Scenario& scenario);

/// Facts of several scenarios in one list. Where they differ, a fact has all its values, in their order.
class GroundFacts {
 public:
  void add(const std::vector<GroundFact>& facts);
  [[nodiscard]] std::vector<GroundFact> merged() const;

 private:
  struct Row {
    std::string name;
    std::vector<std::string> values;
  };
  std::vector<Row> rows_;
};

}  // namespace keyblock::scenario
