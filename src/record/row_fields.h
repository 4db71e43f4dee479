#pragma once
#include <tuple>

namespace keyblock::record {

/// A member of the rows of a table, described once: result.h5 has its column by it, with unit and meaning, and CSV files and Python.
template <class Row, class T>
struct RowField {
  const char* name;
  const char* unit;
  const char* meaning;
  T Row::*member;
};
template <class Row, class T>
RowField(const char*, const char*, const char*, T Row::*) -> RowField<Row, T>;

/// Calls visit(field) for all fields of a table, in their order.
template <class Fields, class Visit>
void visit_fields(const Fields& fields, const Visit& visit) {
  std::apply([&](const auto&... field) { (visit(field), ...); }, fields);
}

}  // namespace keyblock::record
