// Joints between blocks that are given one by one: [[interface]].
#include <fmt/format.h>

#include <algorithm>

#include "scenario/own_joints.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

/// Names of the two blocks.
void read_between(TableReader& t, InterfaceSpec& spec, const Scenario& scenario) {
  const std::vector<std::string>& names = t.context().list_names["block"];
  std::vector<int> blocks;
  const bool is_read =
      t.references("between", blocks, "block",
                   {.meaning = "Names of the two blocks. Wherever they touch, now or later, their contacts "
                               "have these properties.",
                    .required = true});
  if (!is_read) return;
  if (blocks.size() != 2) {
    t.fail("between", fmt::format("{} name{}", blocks.size(), blocks.size() == 1 ? "" : "s"),
           "the names of two blocks");
    return;
  }
  const auto name = [&](std::size_t k) { return names[static_cast<std::size_t>(blocks[k])]; };
  spec.between = std::minmax(name(0), name(1));
  const auto same = std::ranges::find(scenario.interfaces, spec.between, &InterfaceSpec::between);
  if (same != scenario.interfaces.end())
    t.fail("between", fmt::format("'{}' and '{}' again, as in {}", name(0), name(1), same->path),
           "every two blocks once");
  if (spec.name.empty()) spec.name = name(0) + "-" + name(1);
}

void read_interface(TableReader& t, InterfaceSpec& spec, const Scenario& scenario) {
  spec.path = t.path();
  const bool is_named = t.find("name") != nullptr;
  if (t.documenting() || is_named)
    t.name("name", spec.name, "interface",
           {.meaning = "Name in results and key paths.", .fallback = "those of the blocks, as dam-rock"});
  read_between(t, spec, scenario);
  // What name() has compared already is left out.
  const auto is_taken = [&](const OwnJoints& joints) {
    return joints.name == spec.name && !(is_named && joints.path.starts_with("interface"));
  };
  const bool is_of_all =
      spec.name == "joints" || spec.name == "frame";  // words where joints are chosen by name
  if (!spec.name.empty() && (is_of_all || std::ranges::any_of(own_joints(scenario), is_taken)))
    t.fail("name", fmt::format("'{}', which other joints have", spec.name), "a name of its own");
  read_joint_keys_of(t, spec.joints, scenario.joints);
}

}  // namespace

void read_interfaces(TableReader& root, Scenario& scenario) {
  root.each_table(
      "interface",
      {.meaning = "A joint with properties of its own between two [[block]], which is like a joint set "
                  "without traces."},
      [&](TableReader& t) {
        InterfaceSpec spec;
        read_interface(t, spec, scenario);
        if (!t.documenting()) scenario.interfaces.push_back(std::move(spec));
      });
  std::vector<std::string>& names = root.context().list_names[std::string(names_of_joints)];
  for (const InterfaceSpec& spec : scenario.interfaces) names.push_back(spec.name);
}

}  // namespace keyblock::scenario
