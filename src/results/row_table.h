#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "geometry/vec2.h"
#include "record/row_fields.h"
#include "results/hdf5_file.h"
#include "results/table_rows.h"

/// A group of a result file whose columns are the fields of a table (record::RowField), the first of which is `time`.
namespace keyblock::results {

/// How members of rows lie in a file: enumerations as their numbers, vectors as two columns.
template <class T>
struct Stored {
  using Number = T;
  static constexpr std::size_t width = 1;
  static std::array<Number, 1> numbers(T value) { return {value}; }
  static T value(const Number* stored, const char* /*name*/) { return *stored; }
};
template <>
struct Stored<Vec2> {
  using Number = double;
  static constexpr std::size_t width = 2;
  static std::array<Number, 2> numbers(Vec2 value) { return {value.x, value.y}; }
  static Vec2 value(const Number* stored, const char* /*name*/) { return {stored[0], stored[1]}; }
};
/// last_of(E()): the last of the values of an enumeration, found by its argument.
template <class E>
requires std::is_enum_v<E>
struct Stored<E> {
  using Number = std::uint8_t;
  static constexpr std::size_t width = 1;
  static std::array<Number, 1> numbers(E value) { return {static_cast<Number>(value)}; }
  static E value(const Number* stored, const char* name) { return enumerator(*stored, last_of(E()), name); }
};

template <class Row, class... T>
class RowTable {
 public:
  using Fields = std::tuple<record::RowField<Row, T>...>;

  RowTable(hid_t file, const char* group, const Fields& fields)
      : group_(hdf5::create_group(file, group)), fields_(fields) {
    // `time` is made last, as it is written last.
    for_columns<1>([&](const auto& field, auto& column) { make(field, column); });
    make(std::get<0>(fields_), std::get<0>(columns_));
  }
  [[nodiscard]] hid_t group() const { return group_; }

  void append(const Row& row) {
    for_columns<1>([&](const auto& field, auto& column) { put(field, row, column); });
    put(std::get<0>(fields_), row, std::get<0>(columns_));
  }
  void flush() {
    for_columns<1>([](const auto& /*field*/, auto& column) { column.flush(); });
    std::get<0>(columns_).flush();
  }

  /// Rows of which every member is there.
  static std::vector<Row> read(hid_t group, const Fields& fields) {
    const std::tuple<hdf5::Array<typename Stored<T>::Number>...> columns =
        std::apply([&](const auto&... field) { return std::tuple{read_stored(group, field)...}; }, fields);
    std::size_t rows = complete_rows(std::get<0>(columns));
    std::apply([&](const auto&... column) { ((rows = std::min(rows, column.rows())), ...); }, columns);
    std::vector<Row> all(rows);
    take(fields, columns, all, std::index_sequence_for<T...>());
    return all;
  }

 private:
  template <std::size_t first, class Visit>
  void for_columns(const Visit& visit) {
    [&]<std::size_t... k>(std::index_sequence<k...>) {
      (visit(std::get<first + k>(fields_), std::get<first + k>(columns_)), ...);
    }
    (std::make_index_sequence<sizeof...(T) - first>());
  }
  template <class M>
  void make(const record::RowField<Row, M>& field, hdf5::Column<typename Stored<M>::Number>& column) {
    std::vector<hsize_t> shape;
    if (Stored<M>::width > 1) shape.push_back(Stored<M>::width);
    column = hdf5::Column<typename Stored<M>::Number>(group_, field.name, shape);
  }
  template <class M>
  static void put(const record::RowField<Row, M>& field, const Row& row,
                  hdf5::Column<typename Stored<M>::Number>& column) {
    column.append(Stored<M>::numbers(row.*field.member));
  }
  template <class M>
  static hdf5::Array<typename Stored<M>::Number> read_stored(hid_t group,
                                                             const record::RowField<Row, M>& field) {
    auto column = hdf5::read_array<typename Stored<M>::Number>(group, field.name);
    require(column.width() == Stored<M>::width, field.name);
    return column;
  }
  template <class Columns, std::size_t... k>
  static void take(const Fields& fields, const Columns& columns, std::vector<Row>& rows,
                   std::index_sequence<k...> /*all*/) {
    for (std::size_t row = 0; row < rows.size(); ++row)
      ((rows[row].*(std::get<k>(fields).member) =
            Stored<T>::value(&std::get<k>(columns).values[row * Stored<T>::width], std::get<k>(fields).name)),
       ...);
  }

  hdf5::Handle group_;
  Fields fields_;
  std::tuple<hdf5::Column<typename Stored<T>::Number>...> columns_;
};

/// The table of such fields.
template <class Row, class... T>
RowTable<Row, T...> table_of(const std::tuple<record::RowField<Row, T>...>&);
template <class Fields>
using TableOf = decltype(table_of(std::declval<const Fields&>()));

}  // namespace keyblock::results
