#include "contact/joint_faces.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/index.h"

namespace keyblock::contact {

namespace {

Vec2 start_of(const Surface& surface, int edge) {
  return surface.position[at(edge)];
}
Vec2 end_of(const Surface& surface, int edge) {
  return surface.position[at(surface.next[at(edge)])];
}

bool is_divided(const Surface& surface, int edge) {
  return !surface.divided.empty() && surface.divided[at(edge)].pieces > 1;
}

/// From the first to the last vertex of a divided edge, along a direction from a point, m.
std::pair<double, double> extent_of_whole(const Surface& surface, int edge, Vec2 origin, Vec2 direction) {
  const DividedEdge& whole = surface.divided[at(edge)];
  const double from = dot(direction, start_of(surface, whole.first) - origin),
               to = dot(direction, end_of(surface, whole.first + whole.pieces - 1) - origin);
  return std::minmax(from, to);
}

/// Whether a bond of the contact bears tension.
bool is_tensile(const Contact& contact) {
  return contact.fused || (contact.memory.bonded && contact.tension > 0.0);
}

}  // namespace

bool JointFaces::are_there(std::span<const JointLaw> laws) {
  return std::ranges::any_of(laws, [](const JointLaw& law) { return law.normal_stiffness > 0.0; });
}

void JointFaces::find(const Surface& surface, const Tolerances& tolerances, std::span<const JointLaw> laws,
                      std::span<const double> penalty, std::span<Contact> contacts) {
  clear();
  shared_.assign(contacts.size(), 0.0);
  paired_.assign(contacts.size(), 0.0);
  stiffness_.assign(contacts.size(), 0.0);
  for (Contact& contact : contacts) contact.memory.in_face = false;
  const auto pair_of = [&](std::size_t c) { return std::minmax(contacts[c].block_a, contacts[c].block_b); };
  const View view{surface, tolerances, laws, penalty, contacts};
  for (std::size_t c = 0; c < contacts.size();) {
    halves_.clear();
    const auto [low, high] = pair_of(c);
    for (; c < contacts.size() && pair_of(c) == std::pair<const int&, const int&>(low, high); ++c)
      find_halves(view, c);
    take_divided(view);
    take_pairs(view);
  }
  find_left(view);
}

/// The contact has halves along its edge and, at a corner, along the next edge where the face goes on.
void JointFaces::find_halves(const View& view, std::size_t c) {
  const Contact& contact = view.contacts[c];
  const Surface& surface = view.surface;
  const auto add = [&](int line) {
    add_half(view, c, line, contact.vertex);
    add_half(view, c, line, surface.previous[at(contact.vertex)]);
  };
  add(contact.edge);
  if (!contact.at_corner) return;
  const int beyond = (contact.position < 0.5 ? surface.previous : surface.next)[at(contact.edge)];
  const Vec2 tangent = normalized(end_of(surface, beyond) - start_of(surface, beyond));
  const bool goes_on = dot(contact.tangent(), tangent) >= 0.0 &&
                       std::abs(cross(contact.tangent(), tangent)) <= Tolerances::sine_facing;
  if (goes_on) add(beyond);
}

/// side: the edge of the vertex that may face the line.
void JointFaces::add_half(const View& view, std::size_t c, int line, int side) {
  const Surface& surface = view.surface;
  const Contact& contact = view.contacts[c];
  const Vec2 origin = start_of(surface, line), along_line = end_of(surface, line) - origin;
  const double length = norm(along_line);
  const Vec2 tangent = along_line / length, from = start_of(surface, side), to = end_of(surface, side),
             direction = normalized(to - from);
  if (dot(direction, tangent) > 0.0 || std::abs(cross(direction, tangent)) > Tolerances::sine_facing) return;
  const double begin = dot(tangent, to - origin),
               end = dot(tangent, from - origin);  // they run against each other
  const double shared = std::min(end, length) - std::max(begin, 0.0);
  if (shared <= view.tolerances.rounding) return;
  shared_[c] += shared;
  const JointLaw& law = view.laws[at(surface.joint_of(line, contact.block_a, contact.block_b))];
  const double penalty = std::min(view.penalty[at(contact.block_a)], view.penalty[at(contact.block_b)]);
  if (!(law.normal_stiffness > 0.0) || law.normal_stiffness >= penalty) return;
  Half half{.low = std::min(line, side), .high = std::max(line, side), .contact = c};
  const Vec2 start = start_of(surface, half.low);
  half.along = dot(end_of(surface, half.low) - start, surface.position[at(contact.vertex)] - start);
  half.shared = shared;
  half.stiffness = law.normal_stiffness;
  if (contact.fused) half.stiffness = std::max(half.stiffness, penalty);
  stiffness_[c] += half.stiffness * shared;
  halves_.push_back(half);
}

/// Halves of a divided edge that lies against the other side with all of its pieces: all contacts along it share one pressure.
void JointFaces::take_divided(const View& view) {
  if (view.surface.divided.empty()) return;
  for (Half& half : halves_) find_whole(view, half);
  const auto whole_of = [](const Half& half) { return std::pair(half.whole, half.beside); };
  std::ranges::stable_sort(halves_, {}, whole_of);
  for (std::size_t k = 0; k < halves_.size();) {
    std::size_t end = k;
    while (end < halves_.size() && whole_of(halves_[end]) == whole_of(halves_[k])) ++end;
    if (halves_[k].whole >= 0) take_whole(view, std::span(halves_).subspan(k, end - k));
    k = end;
  }
  std::erase_if(halves_, [](const Half& half) { return half.is_taken; });
}

/// Both sides are divided alike, or one of them lies within one piece of the other, as for Surface::start_share.
void JointFaces::find_whole(const View& view, Half& half) {
  const Surface& surface = view.surface;
  const double zone = view.tolerances.end_zone;
  const auto first_of = [&](int edge) { return surface.divided[at(edge)].first; };
  const Vec2 origin = start_of(surface, half.low), tangent = normalized(end_of(surface, half.low) - origin);
  const auto extent = [&](int edge) { return extent_of_whole(surface, edge, origin, tangent); };
  const auto is_within = [&](int edge, int piece) {
    const auto [from, to] = extent(edge);
    const auto [start, end] = std::minmax(
        {dot(tangent, start_of(surface, piece) - origin), dot(tangent, end_of(surface, piece) - origin)});
    return is_divided(surface, edge) && from >= start - zone && to <= end + zone;
  };
  const auto are_alike = [&] {
    const auto [from, to] = extent(half.low);
    const auto [other_from, other_to] = extent(half.high);
    return is_divided(surface, half.low) &&
           surface.divided[at(half.low)].pieces == surface.divided[at(half.high)].pieces &&
           std::max(std::abs(other_from - from), std::abs(other_to - to)) <= zone;
  };
  if (are_alike()) {
    half.whole = first_of(half.low);
    half.beside = first_of(half.high);
  } else if (is_within(half.low, half.high)) {
    half.whole = first_of(half.low);
    half.beside = half.high;
  } else if (is_within(half.high, half.low)) {
    half.whole = first_of(half.high);
    half.beside = half.low;
  }
}

/// A contact stands near each point of the division, or the pieces are faces of their own.
void JointFaces::take_whole(const View& view, std::span<Half> halves) {
  const Surface& surface = view.surface;
  const DividedEdge& whole = surface.divided[at(halves.front().whole)];
  const Vec2 origin = start_of(surface, whole.first),
             along = end_of(surface, whole.first + whole.pieces - 1) - origin;
  const std::vector<double>& points = whole.division->points;
  std::vector<std::size_t> at_point(points.size(), SIZE_MAX);
  for (const Half& half : halves) {
    const Vec2 place = surface.position[at(view.contacts[half.contact].vertex)];
    const double s = dot(along, place - origin) / squared_norm(along);
    const auto nearest = std::ranges::min_element(points, {}, [&](double p) { return std::abs(p - s); });
    std::size_t& contact = at_point[static_cast<std::size_t>(nearest - points.begin())];
    if (contact != SIZE_MAX && contact != half.contact) return;
    contact = half.contact;
  }
  if (std::ranges::count(at_point, SIZE_MAX) > 0) return;
  for (Half& half : halves) {
    paired_[half.contact] += half.shared;
    half.is_taken = true;
  }
  add_face(view, halves.front().stiffness * norm(along), *whole.division, at_point);
}

/// Two contacts at the ends of what two edges share.
void JointFaces::take_pairs(const View& view) {
  const auto edges = [](const Half& half) { return std::tuple(half.low, half.high, half.along); };
  std::ranges::stable_sort(halves_, {}, edges);
  for (std::size_t k = 0; k < halves_.size();) {
    std::size_t last = k;
    while (last + 1 < halves_.size() && halves_[last + 1].low == halves_[k].low &&
           halves_[last + 1].high == halves_[k].high)
      ++last;
    const Half &one = halves_[k], &other = halves_[last];
    if (one.contact != other.contact) {
      const double shared = 0.5 * (one.shared + other.shared);
      paired_[one.contact] += one.shared;
      paired_[other.contact] += other.shared;
      add_face(view, std::min(one.stiffness, other.stiffness) * shared, two_ends(),
               std::array{one.contact, other.contact});
    }
    k = last + 1;
  }
}

void JointFaces::add_face(const View& view, double stiffness, const EdgeDivision& points,
                          std::span<const std::size_t> contacts) {
  const bool pulls =
      std::ranges::all_of(contacts, [&](std::size_t c) { return is_tensile(view.contacts[c]); });
  faces_.push_back({contacts_.size(), JointPressure(stiffness, points, pulls)});
  for (const std::size_t c : contacts) {
    contacts_.push_back(c);
    view.contacts[c].memory.in_face = true;
  }
}

/// What contacts have beyond their faces: of edges whose other end has no contact, and what corners have at the least.
void JointFaces::find_left(const View& view) {
  left_.resize(view.contacts.size());
  for (std::size_t c = 0; c < view.contacts.size(); ++c) {
    const Contact& contact = view.contacts[c];
    left_[c] = contact.normal_stiffness;
    if (paired_[c] == 0.0) continue;
    const double per_length = stiffness_[c] / shared_[c], of_length = per_length * contact.length,
                 at_least = std::max(0.0, contact.normal_stiffness - of_length),
                 missing = per_length * std::max(0.0, view.tolerances.least_length - 0.5 * shared_[c]);
    left_[c] = of_length * (1.0 - std::min(1.0, paired_[c] / shared_[c])) + std::min(at_least, missing);
  }
}

}  // namespace keyblock::contact
