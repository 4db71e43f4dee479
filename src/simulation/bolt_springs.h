#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "coupling/point_springs.h"
#include "model/model.h"
#include "simulation/setup.h"

/// What bolts are to a model: springs between points.
namespace keyblock::simulation {

/// A stretch of a bolt in one block, m from the head.
struct BoltPiece {
  std::size_t block = 0;
  double from = 0.0, to = 0.0;

  [[nodiscard]] double length() const { return to - from; }
};

/// Springs with two points each, and two to draw them from and to.
struct BoltSprings {
  std::vector<dynamics::PointSpring> springs;
  std::vector<dynamics::MaterialPoint> points, drawn;
};

/// Point of a block by its place before the run.
dynamics::MaterialPoint material_point(const dynamics::Model& model, std::size_t block, Vec2 place);

/// Makes springs of one bolt. Numbers of the bolt are of one; springs are per metre of thickness.
class BoltSpringMaker {
 public:
  BoltSpringMaker(const loading::Bolt& bolt, const dynamics::Model& model, BoltSprings& to)
      : bolt_(bolt), model_(model), to_(to) {}

  [[nodiscard]] Vec2 place(double from_head) const {
    return bolt_.head + from_head * ((bolt_.toe - bolt_.head) / bolt_.length());
  }
  [[nodiscard]] dynamics::MaterialPoint point(const BoltPiece& piece, double from_head) const {
    return material_point(model_, piece.block, place(from_head));
  }
  [[nodiscard]] dynamics::PointSpring spring_of(const char* kind, std::string name) const;
  /// Stiffness, capacity in tension, and m of bar that is strained when it yields.
  void set_bar(dynamics::PointSpring& spring, double stiffness, double capacity, double strained) const;
  /// Ends m from the head; the points there, and those that it is drawn along.
  void add(dynamics::PointSpring spring, std::pair<double, double> ends,
           std::pair<dynamics::MaterialPoint, dynamics::MaterialPoint> points,
           std::pair<dynamics::MaterialPoint, dynamics::MaterialPoint> drawn) const;
  /// The dowel of the bar with this number, at the joint between two pieces, where the bolt has one. drawn: m from the head. holes:
  /// PointSpring::holes.
  void add_dowel(int bar, const std::string& name, const BoltPiece& a, const BoltPiece& b,
                 std::pair<double, double> drawn, std::pair<int, int> holes = {-1, -1}) const;
  [[nodiscard]] int next() const { return static_cast<int>(to_.springs.size()); }

 private:
  const loading::Bolt& bolt_;
  const dynamics::Model& model_;
  BoltSprings& to_;
};

}  // namespace keyblock::simulation
