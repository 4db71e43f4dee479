#pragma once
#include <pybind11/numpy.h>

#include <utility>
#include <vector>

namespace keyblock::python {

/// The numbers themselves, which the array owns from now on.
template <typename Number>
pybind11::array_t<Number> array_of(std::vector<Number> values, std::size_t columns = 1) {
  std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(values.size() / columns)};
  if (columns > 1) shape.push_back(static_cast<pybind11::ssize_t>(columns));
  auto* owner = new std::vector<Number>(std::move(values));
  const pybind11::capsule keep(owner, [](void* p) { delete static_cast<std::vector<Number>*>(p); });
  return pybind11::array_t<Number>(shape, owner->data(), keep);
}

}  // namespace keyblock::python
