#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "core/index.h"
#include "simulation/control.h"
#include "simulation/refuse.h"

// Strength of single contacts of a running model.
namespace keyblock::simulation {
namespace {

using contact::ContactStrength;

bool precedes(const ContactStrength& a, const ContactStrength& b) {
  return std::tie(a.vertex, a.edge) < std::tie(b.vertex, b.edge);
}

bool is_same_contact(const ContactStrength& a, const ContactStrength& b) {
  return a.vertex == b.vertex && a.edge == b.edge;
}

bool is_contact(const ContactStrength& of, const contact::Surface& surface) {
  const auto is_place = [&](int k) { return k >= 0 && k < surface.vertices(); };
  return is_place(of.vertex) && is_place(of.edge) &&
         surface.block[at(of.vertex)] != surface.block[at(of.edge)];
}

bool is_allowed(double value) {
  return !ContactStrength::is_given(value) || (std::isfinite(value) && value >= 0.0);
}

void put_given(double value, double& to) {
  if (ContactStrength::is_given(value)) to = value;
}

std::vector<ContactStrength> sorted(std::span<const ContactStrength> strengths) {
  std::vector<ContactStrength> all(strengths.begin(), strengths.end());
  std::stable_sort(all.begin(), all.end(), precedes);
  return all;
}

/// Each contact once, of strengths in their order: of what is given several times, the last.
std::vector<ContactStrength> each_once(std::span<const ContactStrength> strengths) {
  std::vector<ContactStrength> once;
  for (const ContactStrength& one : strengths) {
    if (once.empty() || !is_same_contact(once.back(), one)) {
      once.push_back(one);
      continue;
    }
    put_given(one.friction_coefficient, once.back().friction_coefficient);
    put_given(one.cohesion, once.back().cohesion);
    put_given(one.tension, once.back().tension);
  }
  return once;
}

}  // namespace

void put_contact_strengths(const ControlMemory& memory, dynamics::Model& model) {
  model.contact_strengths.assign(memory.contact_strengths, at(model.surface.vertices()));
}

bool are_contact_strengths(const ControlMemory& memory, const dynamics::Model& model) {
  const std::vector<ContactStrength>& all = memory.contact_strengths;
  return std::is_sorted(all.begin(), all.end(), precedes) &&
         std::adjacent_find(all.begin(), all.end(), is_same_contact) == all.end() &&
         std::all_of(all.begin(), all.end(), [&](const ContactStrength& one) {
           return is_contact(one, model.surface) && is_allowed(one.friction_coefficient) &&
                  is_allowed(one.cohesion) && is_allowed(one.tension);
         });
}

void Control::check_contact(const ContactStrength& strength) const {
  if (!is_contact(strength, model_.surface))
    refuse("contact", fmt::format("vertex {}, edge {}", strength.vertex, strength.edge),
           fmt::format("a vertex and an edge of two blocks, both less than {}", model_.surface.vertices()));
  const auto check = [](const char* key, double value) {
    if (!is_allowed(value)) refuse(key, fmt::format("{}", value), "a finite number, at least 0");
  };
  check("friction", strength.friction_coefficient);
  check("cohesion", strength.cohesion);
  check("tension", strength.tension);
}

void Control::set_contact_strengths(std::span<const ContactStrength> strengths) {
  for (const ContactStrength& strength : strengths) check_contact(strength);
  const std::vector<ContactStrength>& before = memory_.contact_strengths;
  std::vector<ContactStrength> all;
  std::ranges::merge(before, sorted(strengths), std::back_inserter(all), precedes);
  memory_.contact_strengths = each_once(all);
  put_contact_strengths(memory_, model_);
}

void Control::forget_contact_strengths(std::span<const ContactStrength> contacts) {
  for (const ContactStrength& contact : contacts) check_contact(contact);
  const std::vector<ContactStrength> forgotten = sorted(contacts);
  std::erase_if(memory_.contact_strengths, [&](const ContactStrength& one) {
    return std::binary_search(forgotten.begin(), forgotten.end(), one, precedes);
  });
  put_contact_strengths(memory_, model_);
}

}  // namespace keyblock::simulation
