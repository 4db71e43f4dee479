#pragma once
#include <vector>

#include "contact/detection.h"

namespace keyblock::contact {

/// Contacts of a surface as it stands; `list` keeps the memory between calls.
inline std::vector<Contact> find(const Surface& surface, CandidateList& list,
                                 const std::vector<JointLaw>& laws = {JointLaw{}}) {
  const Tolerances tolerances(1.0);
  Candidates candidates(tolerances);
  const std::vector<double> still(static_cast<std::size_t>(surface.blocks()), 0.0);
  ThreadTeam alone(1);
  candidates.update(surface, still, list, alone);
  Detection detection(tolerances, laws, std::vector<double>(static_cast<std::size_t>(surface.blocks()), 1e9));
  std::vector<Contact> contacts;
  detection.find(surface, {still, still, candidates.away(), still}, list, alone, contacts);
  keep_memory(contacts, list, alone);
  return contacts;
}

inline std::vector<Contact> find(const Surface& surface) {
  CandidateList list;
  return find(surface, list);
}

inline double total_length(const std::vector<Contact>& contacts, int a, int b) {
  double sum = 0.0;
  for (const Contact& c : contacts) {
    if ((c.block_a == a && c.block_b == b) || (c.block_a == b && c.block_b == a)) sum += c.length;
  }
  return sum;
}

}  // namespace keyblock::contact
