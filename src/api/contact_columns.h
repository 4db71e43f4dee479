#pragma once
#include <span>

#include "api/edge_names.h"
#include "keyblock/simulation.h"
#include "simulation/record.h"

namespace keyblock::api {

/// Makes columns of contacts that come some at a time.
class ContactColumns {
 public:
  ContactColumns(const simulation::ModelRecord& model, std::size_t count);

  /// Throws std::out_of_range beyond `count` contacts.
  void add(std::span<const simulation::ContactRecord> some);
  /// All of them; at the end.
  [[nodiscard]] Contacts take() { return std::move(contacts_); }

 private:
  EdgeNames names_;
  Contacts contacts_;
  std::size_t count_ = 0;  ///< so far
};

}  // namespace keyblock::api
