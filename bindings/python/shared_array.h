#pragma once
#include <pybind11/numpy.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

namespace keyblock::python {

/// Memory that a simulation fills after each step and that Python may keep as long as it likes: the arrays own it together, so that none
/// of them ever points to what is gone. While no array is left, nothing is copied.
template <typename Number>
class SharedArray {
 public:
  /// Rows of `columns` numbers, as they are now, or as Python has changed them since the last step.
  pybind11::array_t<Number> array(std::span<const Number> now, std::size_t columns, bool writable) {
    if (!memory_ || memory_->size() != now.size()) {
      memory_ = std::make_shared<std::vector<Number>>(now.begin(), now.end());
    } else if (!is_current_) {
      std::copy(now.begin(), now.end(), memory_->begin());
    }
    is_current_ = true;
    auto* owner = new std::shared_ptr<std::vector<Number>>(memory_);
    const pybind11::capsule keep(
        owner, [](void* p) { delete static_cast<std::shared_ptr<std::vector<Number>>*>(p); });
    std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(now.size() / columns)};
    if (columns > 1) shape.push_back(static_cast<pybind11::ssize_t>(columns));
    pybind11::array_t<Number> view(shape, memory_->data(), keep);
    if (!writable) view.attr("setflags")(pybind11::arg("write") = false);
    return view;
  }
  /// After a step.
  void refresh(std::span<const Number> now) {
    is_current_ = false;
    if (memory_.use_count() < 2) return;
    if (memory_->size() != now.size()) {
      memory_.reset();  // arrays of another size keep their last values
      return;
    }
    std::copy(now.begin(), now.end(), memory_->begin());
    is_current_ = true;
  }
  /// Whether Python has put other values in the place of these.
  [[nodiscard]] bool differs(std::span<const Number> now) const {
    return is_current_ && memory_->size() == now.size() &&
           !std::equal(now.begin(), now.end(), memory_->begin());
  }
  [[nodiscard]] std::span<const Number> values() const { return *memory_; }
  /// The values that Python has put there were refused: arrays have those of the simulation again.
  void put(std::span<const Number> now) { std::copy(now.begin(), now.end(), memory_->begin()); }

 private:
  std::shared_ptr<std::vector<Number>> memory_;
  bool is_current_ = false;  ///< it has the values of the last step, except for what Python has changed
};

}  // namespace keyblock::python
