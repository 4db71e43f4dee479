#include "simulation/bolt_springs.h"

#include "core/index.h"

namespace keyblock::simulation {

dynamics::MaterialPoint material_point(const dynamics::Model& model, std::size_t block, Vec2 place) {
  dynamics::MaterialPoint point{static_cast<int>(block), std::vector<double>(at(model.blocks[block].size))};
  model.blocks[block].basis.evaluate(place, point.phi.data());
  return point;
}

dynamics::PointSpring BoltSpringMaker::spring_of(const char* kind, std::string name) const {
  dynamics::PointSpring spring;
  spring.kind = kind;
  spring.name = std::move(name);
  spring.staged = bolt_.staged;
  spring.spacing = bolt_.spacing;
  return spring;
}

void BoltSpringMaker::set_bar(dynamics::PointSpring& spring, double stiffness, double capacity,
                              double strained) const {
  spring.stiffness = stiffness / bolt_.spacing;
  spring.yield = capacity / bolt_.spacing;
  spring.pretension = bolt_.pretension / bolt_.spacing;
  // Where the grout gives way first, the bar comes out and does not strain.
  if (bolt_.rupture_strain && capacity == bolt_.yield) spring.rupture = *bolt_.rupture_strain * strained;
}

void BoltSpringMaker::add(dynamics::PointSpring spring, std::pair<double, double> ends,
                          std::pair<dynamics::MaterialPoint, dynamics::MaterialPoint> points,
                          std::pair<dynamics::MaterialPoint, dynamics::MaterialPoint> drawn) const {
  spring.from = place(ends.first);
  spring.to = place(ends.second);
  to_.springs.push_back(std::move(spring));
  to_.points.push_back(std::move(points.first));
  to_.points.push_back(std::move(points.second));
  to_.drawn.push_back(std::move(drawn.first));
  to_.drawn.push_back(std::move(drawn.second));
}

void BoltSpringMaker::add_dowel(int bar, const std::string& name, const BoltPiece& a, const BoltPiece& b,
                                std::pair<double, double> drawn, std::pair<int, int> holes) const {
  if (bolt_.dowel_stiffness <= 0.0) return;
  dynamics::PointSpring dowel = spring_of("dowel", name + ".dowel");
  dowel.stiffness = bolt_.dowel_stiffness / bolt_.spacing;
  dowel.yield = bolt_.dowel_strength.value_or(HUGE_VAL) / bolt_.spacing;
  if (bolt_.dowel_strength && bolt_.yield) dowel.yield_along = *bolt_.yield / bolt_.spacing;
  dowel.across = bar;
  dowel.holes = holes;
  add(std::move(dowel), {a.to, b.from}, {point(a, a.to), point(b, b.from)},
      {point(a, drawn.first), point(b, drawn.second)});
}

}  // namespace keyblock::simulation
