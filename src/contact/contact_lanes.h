#pragma once
#include <cstddef>
#include <span>

#include "contact/contact.h"
#include "core/lanes.h"

namespace keyblock::contact {

/// Of as many contacts as there are lanes: the eight numbers that follow each other in Contact and in Memory, one lane for each contact.
struct LawLanes {
  Lanes gap, length, depth, normal_stiffness, shear_stiffness, friction, cohesion, tension;
};
struct MemoryLanes {
  Lanes offset, stiffness, shear, normal_force, bounding_force, stored, bond_length, worn;

  /// N: the part of the force that bounds friction that is owed from the steps before, and the other part. A contact that only pulls owes
  /// nothing.
  [[nodiscard]] Lanes owed() const {
    return where(normal_force > Lanes{}, bounding_force - normal_force, Lanes{});
  }
  [[nodiscard]] Lanes bounding_normal() const {
    return where(normal_force > Lanes{}, normal_force, bounding_force);
  }
};
static_assert(offsetof(Contact, tension) - offsetof(Contact, gap) == (lane_count - 1) * sizeof(double));
static_assert(offsetof(Memory, worn) - offsetof(Memory, offset) == (lane_count - 1) * sizeof(double));

/// Numbers of `some`, at least one, that begin at begin(each); lanes beyond the last are those of the first.
template <typename Components, typename Some, typename Begin>
Components components_of(std::span<const Some> some, const Begin& begin) {
  Lanes lines[lane_count];
  for (std::size_t i = 0; i < lane_count; ++i) lines[i] = load(begin(some[i < some.size() ? i : 0]));
  transpose(lines);
  return {lines[0], lines[1], lines[2], lines[3], lines[4], lines[5], lines[6], lines[7]};
}
inline LawLanes laws_of(std::span<const Contact> contacts) {
  return components_of<LawLanes>(contacts, [](const Contact& c) { return &c.gap; });
}
inline MemoryLanes memories_of(std::span<const Contact> contacts) {
  return components_of<MemoryLanes>(contacts, [](const Contact& c) { return &c.memory.offset; });
}
/// Back into as many contacts.
inline void keep(const LawLanes& law, std::span<Contact> contacts) {
  Lanes lines[lane_count] = {
      law.gap,      law.length,   law.depth,  law.normal_stiffness, law.shear_stiffness,
      law.friction, law.cohesion, law.tension};
  transpose(lines);
  for (std::size_t i = 0; i < lane_count && i < contacts.size(); ++i) store(&contacts[i].gap, lines[i]);
}
/// Into as many memories, the first of them memory_of(0).
template <typename MemoryOf>
void keep(const MemoryLanes& m, std::size_t count, const MemoryOf& memory_of) {
  Lanes lines[lane_count] = {m.offset,         m.stiffness, m.shear,       m.normal_force,
                             m.bounding_force, m.stored,    m.bond_length, m.worn};
  transpose(lines);
  for (std::size_t i = 0; i < lane_count && i < count; ++i) store(&memory_of(i).offset, lines[i]);
}

/// number(each) of `some`, likewise.
template <typename Some, typename Number>
Lanes lanes_of(std::span<const Some> some, const Number& number) {
  return each_lane([&](std::size_t i) { return number(some[i < some.size() ? i : 0]); });
}
/// Whether `is` of each.
template <typename Some, typename Is>
auto lanes_where(std::span<const Some> some, const Is& is) {
  return lanes_of(some, [&](const Some& one) { return is(one) ? 1.0 : 0.0; }) > 0.0;
}

}  // namespace keyblock::contact
