#pragma once
#include <cstddef>
#include <span>

#include "contact/detection.h"
#include "core/lanes.h"

namespace keyblock::dynamics {

/// Of as many contacts as there are lanes, by component: as many numbers as stand side by side in each.
struct LawLanes {
  Lanes gap, length, depth, normal_stiffness, shear_stiffness, friction, cohesion, tension;
};
struct MemoryLanes {
  Lanes offset, stiffness, shear, normal_force, bounding_force, multiplier, drift, stored;
};
static_assert(offsetof(contact::Contact, tension) - offsetof(contact::Contact, gap) ==
              (lane_count - 1) * sizeof(double));
static_assert(offsetof(contact::Memory, stored) - offsetof(contact::Memory, offset) ==
              (lane_count - 1) * sizeof(double));

/// Of the first contacts, at least one; lanes beyond the last contact are those of the first.
template <typename Components, typename Begin>
Components components_of(std::span<const contact::Contact> contacts, const Begin& begin) {
  Lanes lines[lane_count];
  for (std::size_t i = 0; i < lane_count; ++i) lines[i] = load(begin(contacts[i < contacts.size() ? i : 0]));
  transpose(lines);
  return {lines[0], lines[1], lines[2], lines[3], lines[4], lines[5], lines[6], lines[7]};
}
inline LawLanes laws_of(std::span<const contact::Contact> contacts) {
  return components_of<LawLanes>(contacts, [](const contact::Contact& c) { return &c.gap; });
}
inline MemoryLanes memories_of(std::span<const contact::Contact> contacts) {
  return components_of<MemoryLanes>(contacts, [](const contact::Contact& c) { return &c.memory.offset; });
}
/// Back into as many contacts.
inline void keep(const MemoryLanes& m, std::span<contact::Contact> contacts) {
  Lanes lines[lane_count] = {m.offset,         m.stiffness,  m.shear, m.normal_force,
                             m.bounding_force, m.multiplier, m.drift, m.stored};
  transpose(lines);
  for (std::size_t i = 0; i < lane_count && i < contacts.size(); ++i)
    store(&contacts[i].memory.offset, lines[i]);
}

/// number(contact) of each.
template <typename Number>
Lanes lanes_of(std::span<const contact::Contact> contacts, const Number& number) {
  const auto of = [&](std::size_t i) { return number(contacts[i < contacts.size() ? i : 0]); };
  return lanes_from(of(0), of(1), of(2), of(3), of(4), of(5), of(6), of(7));
}
/// Whether `is` of each.
template <typename Is>
auto lanes_where(std::span<const contact::Contact> contacts, const Is& is) {
  return lanes_of(contacts, [&](const contact::Contact& c) { return is(c) ? 1.0 : 0.0; }) > 0.0;
}

}  // namespace keyblock::dynamics
