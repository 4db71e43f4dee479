#include "simulation/outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "../scene.h"
#include "core/index.h"
#include "geometry/quadrature.h"

namespace keyblock::simulation {
namespace {

/// Two blocks on a third one, turned by `angle`: x from 0 to `foot` and to 3 above, 0 to 3 below.
struct TJunction {
  Scene scene{1e9, 30.0};
  double angle;

  TJunction(double foot, int below, int above, double turned = 0.0, double gap = 0.0) : angle(turned) {
    scene.rectangle(at_x(0.0, -1.0), 3.0, 1.0, angle, false, below);
    scene.rectangle(at_x(0.0, gap), foot, 1.0, angle, false, above);
    scene.rectangle(at_x(foot, gap), 3.0 - foot, 1.0, angle, false, above);
  }
  [[nodiscard]] Vec2 at_x(double x, double y) const {
    const double c = std::cos(angle * degree), s = std::sin(angle * degree);
    return {c * x - s * y, s * x + c * y};
  }
  /// m, along the joint: vertices there of some blocks, ascending, those that coincide once.
  [[nodiscard]] std::vector<double> vertices(const dynamics::Model& model, int first, int last) const {
    std::vector<double> found;
    for (int v = model.surface.block_begin[at(first)]; v < model.surface.block_begin[at(last) + 1]; ++v) {
      const Vec2 p = model.reference[at(v)];
      const double c = std::cos(angle * degree), s = std::sin(angle * degree);
      if (std::abs(c * p.y - s * p.x) < 1e-2) found.push_back(c * p.x + s * p.y);
    }
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end(), [](double a, double b) { return b - a < 1e-9; }),
                found.end());
    return found;
  }
};

void expect_near(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-9);
}

/// Ends and points of the rule of n pieces in each stretch.
std::vector<double> by_rule(const std::vector<double>& ends, int n) {
  std::vector<double> points{ends.front()};
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    for (int i = 1; i <= n; ++i)
      points.push_back(std::lerp(ends[k], ends[k + 1], gauss_lobatto(n + 1).points[at(i)]));
  }
  return points;
}

TEST(Outline, EdgesAreCutWhereBlocksBeyondThemEndAndDividedAlikeOnBothSides) {
  for (const double angle : {0.0, 17.0, -120.0}) {
    for (const auto& [below, above] : {std::pair{2, 2}, {3, 3}, {2, 3}, {4, 2}}) {
      const TJunction t(1.1, below, above, angle);
      const dynamics::Model model = build_model(t.scene.setup);
      const std::vector<double> expected = by_rule({0.0, 1.1, 3.0}, std::max(below, above));
      expect_near(t.vertices(model, 0, 0), expected);
      expect_near(t.vertices(model, 1, 2), expected);
    }
  }
}

// Blocks of order 1 do not bend. Those on the other side of their edges do, and are cut where these end.
TEST(Outline, EdgesOfBlocksOfOrder1StayWhole) {
  const TJunction straight_above(1.1, 3, 1), straight_below(1.1, 1, 3);
  const dynamics::Model one = build_model(straight_above.scene.setup),
                        other = build_model(straight_below.scene.setup);
  expect_near(straight_above.vertices(one, 0, 0), by_rule({0.0, 1.1, 3.0}, 3));
  expect_near(straight_above.vertices(one, 1, 2), {0.0, 1.1, 3.0});
  expect_near(straight_below.vertices(other, 0, 0), {0.0, 3.0});
  expect_near(straight_below.vertices(other, 1, 2), by_rule({0.0, 1.1, 3.0}, 3));
  EXPECT_TRUE(build_model(TJunction(1.1, 1, 1).scene.setup).surface.divided.empty());
}

TEST(Outline, FacesHaveAsManyContactsAsAreAskedFor) {
  for (const int order : {1, 2}) {
    TJunction t(1.1, order, 1);
    t.scene.setup.solver.face_contacts = 3;
    const dynamics::Model model = build_model(t.scene.setup);
    expect_near(t.vertices(model, 0, 0), by_rule({0.0, 1.1, 3.0}, 2));
    expect_near(t.vertices(model, 1, 2), by_rule({0.0, 1.1, 3.0}, 2));
  }
  TJunction on_fixed(1.1, 3, 1);
  on_fixed.scene.setup.solver.face_contacts = 3;
  on_fixed.scene.setup.properties[0].fixed = true;
  const dynamics::Model model = build_model(on_fixed.scene.setup);
  expect_near(on_fixed.vertices(model, 0, 0), {0.0, 3.0});
  expect_near(on_fixed.vertices(model, 1, 2), by_rule({0.0, 1.1, 3.0}, 2));
}

TEST(Outline, NothingIsCutNearAnEndOrWhereBlocksAreApart) {
  const TJunction near_end(0.002, 2, 1), apart(1.1, 2, 2, 0.0, 0.001);
  expect_near(near_end.vertices(build_model(near_end.scene.setup), 0, 0), by_rule({0.0, 3.0}, 2));
  expect_near(apart.vertices(build_model(apart.scene.setup), 0, 0), by_rule({0.0, 3.0}, 2));
}

// A corner that stands on an edge has no stretch in common with it.
TEST(Outline, NothingIsCutByATip) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, -1.0}, 3.0, 1.0, 0.0, false, 2);
  scene.rectangle({1.1, 0.0}, 1.0, 1.0, 30.0, false, 2);
  const dynamics::Model model = build_model(scene.setup);
  EXPECT_EQ(model.surface.block_begin[1], 8);
}

// Blocks that meet at a point where two joints cross at a small angle have nothing of their edges in common.
TEST(Outline, NothingIsCutWhereJointsCross) {
  for (const auto& [angle, vertices] : {std::pair{3.0, 3}, {0.001, 6}}) {
    Scene scene(1e9, 30.0);
    const double rise = 2.0 * std::tan(angle * degree);
    scene.add({{0.0, -1.0}, {3.0, -1.0}, {3.0, 0.0}, {0.0, 0.0}}, false, 2);
    scene.add({{0.0, 0.0}, {2.0, rise}, {2.0, 1.0}, {0.0, 1.0}}, false, 3);
    const dynamics::Model model = build_model(scene.setup);
    const std::span<const Vec2> below =
        std::span<const Vec2>(model.reference).first(at(model.surface.block_begin[1]));
    EXPECT_EQ(std::ranges::count_if(below, [](Vec2 p) { return p.y == 0.0; }), vertices) << angle;
  }
}

// Of every edge of the surface it is known which edge of which polygon it lies on.
TEST(Outline, EdgesKnowWhatTheyAreOf) {
  TJunction t(1.1, 2, 3, 17.0);
  const dynamics::Model model = build_model(t.scene.setup);
  const contact::Surface& surface = model.surface;
  ASSERT_EQ(model.outline_edge.size(), at(surface.vertices()));
  EXPECT_GT(surface.vertices(), 3 * 4 * 2);
  for (std::size_t e = 0; e < model.outline_edge.size(); ++e) {
    const std::size_t edge = at(model.outline_edge[e]), block = edge / 4, k = edge % 4;
    EXPECT_EQ(at(surface.block[e]), block);
    const Ring& ring = model.blocks[block].reference.outer;
    const Vec2 a = ring[k], b = ring[(k + 1) % 4];
    for (const Vec2 p : {model.reference[e], model.reference[at(surface.next[e])]})
      EXPECT_NEAR(norm(p - a) + norm(p - b), norm(b - a), 1e-12);
  }
}

// Every point of the joint has one contact, with the weight that the rule gives it: of both stretches where they meet.
TEST(Outline, ContactsHaveTheWeightsOfTheRule) {
  for (const auto& [below, above] : {std::pair{2, 2}, {3, 3}, {2, 3}, {1, 2}, {3, 1}}) {
    const TJunction t(1.1, below, above);
    dynamics::Model model = build_model(t.scene.setup);
    dynamics::State state = initial_state(t.scene.setup, model);
    ThreadTeam alone(1);
    Profile profile;
    dynamics::Stepper stepper(model, alone, profile);
    stepper.start(state);
    const int n = std::max(below, above);
    const LineRule& rule = gauss_lobatto(n + 1);
    const std::vector<double> points = by_rule({0.0, 1.1, 3.0}, n);
    std::vector<double> expected(points.size(), 0.0), found = expected;
    for (int i = 0; i <= n; ++i) {
      expected[at(i)] += 1.1 * rule.weights[at(i)];
      expected[at(n + i)] += 1.9 * rule.weights[at(i)];
    }
    for (const contact::Contact& c : stepper.find_contacts(state)) {
      if (c.block_a != 0 && c.block_b != 0) continue;
      const double x = model.reference[at(c.vertex)].x;
      const auto point = std::ranges::find_if(points, [&](double p) { return std::abs(p - x) < 1e-9; });
      ASSERT_NE(point, points.end()) << x;
      found[static_cast<std::size_t>(point - points.begin())] += c.length;
    }
    expect_near(found, expected);
  }
}

// As blocks slide, the weights of the rule fade into halves: what a block is held by stays right in force and moment, and changes step by
// step as it goes.
TEST(Outline, WeightsOfTheRuleFadeAsBlocksSlide) {
  const double width = 1.1;
  // Moments of what holds the block on the left about its middle, over what they are where it is held evenly.
  const auto held_at = [&](double slid, int order) {
    const TJunction t(width, order, order);
    dynamics::Model model = build_model(t.scene.setup);
    dynamics::State state = initial_state(t.scene.setup, model);
    for (const std::size_t b : {1U, 2U})
      state.position[model.blocks[b].first] += slid * std::sqrt(model.blocks[b].area);
    ThreadTeam alone(1);
    Profile profile;
    dynamics::Stepper stepper(model, alone, profile);
    stepper.start(state);
    std::array<double, 3> moments{};
    for (const contact::Contact& c : stepper.find_contacts(state)) {
      if (std::min(c.block_a, c.block_b) != 0 || std::max(c.block_a, c.block_b) != 1) continue;
      const double x = (model.surface.position[at(c.vertex)].x - slid) / (0.5 * width) - 1.0;
      for (std::size_t k = 0; k < moments.size(); ++k)
        moments[k] += static_cast<double>(k + 1) * c.length / width * std::pow(x, k);
    }
    return moments;
  };
  for (const int order : {2, 3, 4}) {
    const std::array<double, 3> in_place = held_at(0.0, order);
    for (const std::size_t k : {0U, 2U}) EXPECT_NEAR(in_place[k], 1.0, 1e-9);
    double before = in_place[2];
    for (double slid = 0.01; slid < 0.5; slid += 0.01) {
      const std::array<double, 3> moment = held_at(slid, order);
      EXPECT_NEAR(moment[0], 1.0, 5e-3) << order << ", " << slid;
      EXPECT_NEAR(moment[1], 0.0, 5e-3) << order << ", " << slid;
      EXPECT_NEAR(moment[2], 1.0, slid < 0.2 ? 0.04 : 0.4) << order << ", " << slid;
      EXPECT_NEAR(moment[2], before, 0.04) << order << ", " << slid;
      before = moment[2];
    }
  }
}

TEST(Outline, CornersThatAreStraightButForRoundingAreNotReflex) {
  Scene scene(1e9, 30.0);
  const auto on_slope = [](double x) { return Vec2{x, 0.3 * x}; };
  Ring ring;
  for (const double x : {0.0, 0.1, 0.3, 0.7, 0.9, 1.0}) ring.push_back(on_slope(x));
  ring.push_back({0.0, 1.0});
  scene.add(ring);
  const dynamics::Model model = build_model(scene.setup);
  for (std::size_t v = 0; v < model.surface.kind.size(); ++v) EXPECT_FALSE(model.surface.is_reflex(v));
}

}  // namespace
}  // namespace keyblock::simulation
