#pragma once
#include <pybind11/pybind11.h>

#include "keyblock/value.h"

namespace keyblock::python {

/// A text, path, boolean, number, mapping, or anything that can be iterated: lists, tuples, arrays of numpy. Members of mappings that are
/// None are left out. Throws TypeError for other values, ValueError for more than 32 lists and tables within each other.
Value value_of(const pybind11::handle& object);

/// Lists, dictionaries, texts and numbers.
pybind11::object object_of(const Value& value);

}  // namespace keyblock::python
