#include "contact/contact.h"

#include "core/index.h"

namespace keyblock::contact {

void keep_memory(std::span<const Contact> contacts, CandidateList& candidates, ThreadTeam& team) {
  candidates.make_room(contacts.size());
  team.for_range(contacts.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      candidates.memory[k] = contacts[k].memory;
      candidates.track(k, contacts[k].candidate);
    }
  });
}

}  // namespace keyblock::contact
