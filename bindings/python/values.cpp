#include "values.h"

#include <pybind11/numpy.h>

#include <string>

namespace py = pybind11;

namespace keyblock::python {
namespace {

constexpr int deepest = 32;

Value convert(const py::handle& object, int depth);

/// What Python calls by one of its modules, loaded once: they live as long as the interpreter.
py::handle abstract(const char* module, const char* name) {
  return py::object(py::module_::import(module).attr(name)).release();
}

bool is_a(const py::handle& object, const py::handle& type) {
  const int answer = PyObject_IsInstance(object.ptr(), type.ptr());
  if (answer < 0) throw py::error_already_set();
  return answer != 0;
}

std::string text_of(const py::handle& object) {
  return py::reinterpret_steal<py::object>(PyUnicode_AsUTF8String(object.ptr()))
             ? py::cast<std::string>(object)
             : throw py::error_already_set();
}

[[noreturn]] void refuse(const py::handle& object) {
  throw py::type_error("a scenario has no values of type " +
                       py::cast<std::string>(py::type::handle_of(object).attr("__name__")));
}

Value integer_of(const py::handle& object) {
  int overflow = 0;
  const long long value = PyLong_AsLongLongAndOverflow(object.ptr(), &overflow);
  if (overflow != 0) throw py::value_error("whole numbers of a scenario have 64 bits");
  if (value == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  return static_cast<std::int64_t>(value);
}

Value table_of(const py::handle& mapping, int depth) {
  Value::Table table;
  const py::object items = mapping.attr("items")();
  for (const py::handle& item : items) {
    const auto pair = py::reinterpret_borrow<py::tuple>(item);
    if (pair[1].is_none()) continue;
    table.emplace_back(text_of(py::str(pair[0])), convert(pair[1], depth - 1));
  }
  return table;
}

Value list_of(const py::handle& object, int depth) {
  Value::List list;
  for (const py::handle& item : py::iter(object)) list.push_back(convert(item, depth - 1));
  return list;
}

/// Arrays of doubles, row by row.
Value rows_of(const py::array& array) {
  const auto numbers = py::array_t<double, py::array::c_style | py::array::forcecast>(array);
  const auto columns = static_cast<std::size_t>(array.ndim() == 2 ? array.shape(1) : 1);
  const std::span<const double> all(numbers.data(), static_cast<std::size_t>(numbers.size()));
  if (array.ndim() == 1) return Value::rows(all);
  Value::List list;
  list.reserve(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t k = 0; k < static_cast<std::size_t>(array.shape(0)); ++k)
    list.push_back(Value::rows(all.subspan(k * columns, columns)));
  return list;
}

Value convert_other(const py::handle& object, int depth) {
  static const py::handle path = abstract("os", "PathLike"), fsdecode = abstract("os", "fsdecode");
  static const py::handle integral = abstract("numbers", "Integral"), real = abstract("numbers", "Real");
  static const py::handle mapping = abstract("collections.abc", "Mapping"),
                          iterable = abstract("collections.abc", "Iterable");
  if (py::hasattr(object, "item") && py::hasattr(object, "ndim") &&
      py::object(object.attr("ndim")).equal(py::int_(0)))
    return convert(object.attr("item")(), depth);
  if (is_a(object, path)) return Value::text(text_of(fsdecode(object)));
  if (is_a(object, integral)) return integer_of(py::int_(py::reinterpret_borrow<py::object>(object)));
  if (is_a(object, real)) return py::cast<double>(py::float_(py::reinterpret_borrow<py::object>(object)));
  if (is_a(object, mapping)) return table_of(object, depth);
  const bool is_bytes =
      PyBytes_Check(object.ptr()) || PyByteArray_Check(object.ptr()) || PyMemoryView_Check(object.ptr());
  if (is_bytes || !is_a(object, iterable)) refuse(object);
  return list_of(object, depth);
}

Value convert(const py::handle& object, int depth) {
  if (depth == 0) throw py::value_error("lists and tables lie too deep within each other");
  PyObject* const o = object.ptr();
  if (PyFloat_CheckExact(o)) return PyFloat_AS_DOUBLE(o);
  if (PyBool_Check(o)) return o == Py_True;
  if (PyLong_CheckExact(o)) return integer_of(object);
  if (PyUnicode_Check(o)) return Value::text(text_of(object));
  if (PyList_CheckExact(o) || PyTuple_CheckExact(o)) return list_of(object, depth);
  if (PyDict_CheckExact(o)) return table_of(object, depth);
  if (py::isinstance<py::array>(object)) {
    const auto array = py::reinterpret_borrow<py::array>(object);
    if (array.dtype().kind() == 'f' && (array.ndim() == 1 || array.ndim() == 2)) return rows_of(array);
  }
  return convert_other(object, depth);
}

}  // namespace

Value value_of(const py::handle& object) {
  return convert(object, deepest);
}

namespace {

struct ToObject {
  py::object operator()(bool value) const { return py::bool_(value); }
  py::object operator()(std::int64_t value) const { return py::int_(value); }
  py::object operator()(double value) const { return py::float_(value); }
  py::object operator()(const std::string& value) const { return py::str(value); }
  py::object operator()(const Value::List& list) const {
    py::list made(list.size());
    for (std::size_t k = 0; k < list.size(); ++k) made[k] = object_of(list[k]);
    return made;
  }
  py::object operator()(const Value::Table& table) const {
    py::dict made;
    for (const auto& [key, value] : table) made[py::str(key)] = object_of(value);
    return made;
  }
};

}  // namespace

py::object object_of(const Value& value) {
  return std::visit(ToObject{}, value.is);
}

}  // namespace keyblock::python
