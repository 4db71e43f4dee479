#include "contact/candidates.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "contact/box_grid.h"
#include "contact/deep_contacts.h"
#include "core/index.h"

namespace keyblock::contact {

double distance_to_segment(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double s = std::clamp(dot(p - a, d) / squared_norm(d), 0.0, 1.0);
  return norm(p - a - s * d);
}

namespace {

/// What is known of pairs of blocks stays, except for pairs with a block that is searched again.
void find_block_pairs(std::span<const std::uint8_t> dirty, CandidateList& list) {
  const std::vector<BlockPair> known = std::exchange(list.block_pairs, {});
  list.block_pairs.reserve(known.size());
  auto last = known.begin();
  int a = -1, b = -1;
  for (std::size_t k = 0; k < list.pairs.size(); ++k) {
    const auto [low, high] = std::minmax(list.pairs[k].block_a, list.pairs[k].block_b);
    if (low == a && high == b) continue;
    a = low;
    b = high;
    BlockPair pair;
    if (dirty[at(a)] == 0 && dirty[at(b)] == 0) {
      while (last != known.end() && std::pair(last->block_a, last->block_b) < std::pair(a, b)) ++last;
      if (last != known.end() && last->block_a == a && last->block_b == b) pair = *last;
    }
    pair.first = static_cast<int>(k);
    pair.block_a = a;
    pair.block_b = b;
    list.block_pairs.push_back(pair);
  }
}

/// The pairs of each of so many blocks.
void index_block_pairs(std::size_t blocks, CandidateList& list) {
  list.first_of_block.assign(blocks + 1, 0);
  for (const BlockPair& pair : list.block_pairs) {
    ++list.first_of_block[at(pair.block_a) + 1];
    ++list.first_of_block[at(pair.block_b) + 1];
  }
  std::partial_sum(list.first_of_block.begin(), list.first_of_block.end(), list.first_of_block.begin());
  std::vector<int> next(list.first_of_block.begin(), list.first_of_block.end() - 1);
  list.pair_of_block.resize(2 * list.block_pairs.size());
  for (std::size_t p = 0; p < list.block_pairs.size(); ++p) {
    for (const int block : {list.block_pairs[p].block_a, list.block_pairs[p].block_b})
      list.pair_of_block[at(next[at(block)]++)] = static_cast<int>(p);
  }
}

}  // namespace

void Candidates::measure_motion(const Surface& surface, std::span<const double> reach, ThreadTeam& team) {
  team.for_range(away_.size(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      if (!surface.present[b]) continue;
      double moved = 0.0;
      for (auto v = at(surface.block_begin[b]); v < at(surface.block_begin[b + 1]); ++v) {
        moved = std::max(moved, squared_norm(surface.position[v] - searched_at_[v]));
      }
      away_[b] = std::sqrt(moved) + reach[b];
    }
  });
}

/// Which blocks are searched again, and from where.
Candidates::Dirty Candidates::begin_search(const Surface& surface, std::span<const double> reach,
                                           ThreadTeam& team) {
  const auto blocks = at(surface.blocks());
  const bool all = searched_at_.empty();
  Dirty dirty{{}, std::vector<std::uint8_t>(blocks, all)};
  if (all) {
    searched_at_.assign(surface.position.size(), Vec2{});
    margin_.assign(blocks, 0.0);
    box_.assign(blocks, Box{});
    away_.assign(blocks, 0.0);
  } else {
    measure_motion(surface, reach, team);
  }
  for (std::size_t b = 0; b < blocks; ++b) {
    if (!all && (!surface.present[b] || away_[b] <= margin_[b])) continue;
    dirty.is[b] = 1;
    dirty.blocks.push_back(static_cast<int>(b));
    away_[b] = reach[b];
    margin_[b] = surface.fixed[b] && reach[b] == 0.0 ? 0.0 : tolerances_.margin + 4.0 * reach[b];
    box_[b] = {};
    for (auto v = at(surface.block_begin[b]); v < at(surface.block_begin[b + 1]); ++v) {
      searched_at_[v] = surface.position[v];
      box_[b].add(surface.position[v]);
    }
    box_[b] = box_[b].grown(margin_[b] + tolerances_.depth_limit);
  }
  return dirty;
}

bool Candidates::update(const Surface& surface, std::span<const double> reach, CandidateList& list,
                        ThreadTeam& team) {
  const Dirty dirty = begin_search(surface, reach, team);
  bool changed = false;
  if (!dirty.blocks.empty()) {
    pressed_ = pressed_depths(list, tolerances_, at(surface.blocks()));
    std::vector<Candidate> found = collect(surface, dirty);
    add_held(surface, dirty, list, found);
    changed = !is_unchanged(found, dirty, list);
    if (changed) merge(found, dirty, list);
  }
  if (changed || list.block_pairs.empty()) {
    find_block_pairs(dirty.is, list);
    index_block_pairs(at(surface.blocks()), list);
  } else {
    for (const int block : dirty.blocks) {
      for (const int pair : list.pairs_of(block)) list.block_pairs[at(pair)].steady.forget();
    }
  }
  return changed;
}

namespace {

/// The order of a CandidateList.
bool comes_before(const Candidate& x, const Candidate& y) {
  const auto key = [](const Candidate& c) {
    const auto [low, high] = std::minmax(c.block_a, c.block_b);
    return std::tuple(low, high, c.vertex, c.edge);
  };
  return key(x) < key(y);
}

/// Blocks whose boxes overlap with the box of a block, ascending. A grid over all boxes is worth building for many blocks; a few are compared
/// with all others sooner.
class Neighbours {
 public:
  Neighbours(std::span<const Box> boxes, std::span<const std::uint8_t> present, std::size_t blocks)
      : boxes_(boxes), present_(present) {
    constexpr std::size_t few = 32;
    if (blocks > few) grid_.emplace(boxes, present);
  }
  std::span<const int> of(int block) {
    if (grid_) {
      grid_->query(block, found_);
      return found_;
    }
    found_.clear();
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
      if (b != at(block) && present_[b] && boxes_[b].overlaps(boxes_[at(block)]))
        found_.push_back(static_cast<int>(b));
    }
    return found_;
  }

 private:
  std::span<const Box> boxes_;
  std::span<const std::uint8_t> present_;
  std::optional<BoxGrid> grid_;
  std::vector<int> found_;
};

}  // namespace

/// Candidates of the blocks that are searched again, in order.
std::vector<Candidate> Candidates::collect(const Surface& surface, const Dirty& dirty) const {
  std::vector<Candidate> found;
  Neighbours neighbours(box_, surface.present, dirty.blocks.size());
  for (const int a : dirty.blocks) {
    if (!surface.present[at(a)]) continue;
    for (const int b : neighbours.of(a)) {
      if (dirty.is[at(b)] && b < a) continue;  // done from the other side
      if (surface.fixed[at(a)] && surface.fixed[at(b)]) continue;
      collect_pair(surface, a, b, found);
      collect_pair(surface, b, a, found);
    }
  }
  // Of all blocks they come in order.
  if (!std::is_sorted(found.begin(), found.end(), comes_before))
    std::sort(found.begin(), found.end(), comes_before);
  return found;
}

/// Calls of_candidate(k, memory) for the candidates in the list that have a block that is searched again, in their order. memory: where their
/// memory is; −1: none.
template <typename OfCandidate>
void Candidates::for_old(const Dirty& dirty, const CandidateList& list, const OfCandidate& of_candidate) {
  constexpr std::size_t many = 8;  // of which all blocks are as many times as many, or fewer
  if (list.block_pairs.empty() || many * dirty.blocks.size() > dirty.is.size()) {
    CandidateList::Finder memory_of(list, 0);
    for (std::size_t k = 0; k < list.pairs.size(); ++k) {
      if (dirty.has_one_of(list.pairs[k])) of_candidate(k, memory_of(k));
    }
    return;
  }
  std::vector<int> pairs;
  for (const int block : dirty.blocks) {
    const std::span<const int> of_block = list.pairs_of(block);
    pairs.insert(pairs.end(), of_block.begin(), of_block.end());
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const int p : pairs) {
    const int first = list.block_pairs[at(p)].first;
    CandidateList::Finder memory_of(list, first);
    for (std::size_t k = at(first); k < list.end_of_pair(at(p)); ++k) of_candidate(k, memory_of(k));
  }
}

/// Adds contacts that hold, but are too deep or too far apart to be found.
void Candidates::add_held(const Surface& surface, const Dirty& dirty, const CandidateList& list,
                          std::vector<Candidate>& found) {
  const std::size_t collected = found.size();
  std::size_t next = 0;
  for_old(dirty, list, [&](std::size_t k, int memory) {
    const Candidate& c = list.pairs[k];
    if (memory < 0 || !list.memory[at(memory)].holds() || !surface.present[at(c.block_a)] ||
        !surface.present[at(c.block_b)])
      return;
    while (next < collected && comes_before(found[next], c)) ++next;
    if (next == collected || comes_before(c, found[next])) found.push_back(c);
  });
  if (found.size() > collected) std::sort(found.begin(), found.end(), comes_before);
}

/// Whether what was found is what the list has: a block that moves through the air, or shifts a little among its neighbours, leaves the list
/// as it is. Clearances are brought up to date.
bool Candidates::is_unchanged(std::span<const Candidate> found, const Dirty& dirty, CandidateList& list) {
  std::size_t same = 0, old = 0;
  for_old(dirty, list, [&](std::size_t k, int memory) {
    if (same != old++ || same == found.size()) return;
    Candidate& c = list.pairs[k];
    if (found[same].vertex != c.vertex || found[same].edge != c.edge) return;
    c.clearance = memory >= 0 && list.memory[at(memory)].holds() ? 0.0 : found[same].clearance;
    ++same;
  });
  return same == found.size() && old == found.size();
}

/// Puts what was found into the list, instead of all candidates of the same blocks.
void Candidates::merge(std::span<const Candidate> found, const Dirty& dirty, CandidateList& list) {
  CandidateList merged;
  merged.block_pairs = std::move(list.block_pairs);
  merged.pieces = std::move(list.pieces);
  merged.pairs.reserve(list.pairs.size() + found.size());
  CandidateList::Finder memory_of(list, 0);
  const auto add = [&](const Candidate& c, int memory) {
    merged.pairs.push_back(c);
    if (memory < 0) return;
    merged.tracked.push_back(static_cast<int>(merged.pairs.size()) - 1);
    merged.memory.push_back(list.memory[at(memory)]);
    if (list.memory[at(memory)].holds()) merged.pairs.back().clearance = 0.0;
  };
  std::size_t k = 0;
  const auto add_old = [&] {
    if (!dirty.has_one_of(list.pairs[k])) add(list.pairs[k], memory_of(k));
    ++k;
  };
  for (const Candidate& c : found) {
    while (k < list.pairs.size() && comes_before(list.pairs[k], c)) add_old();
    const bool known = k < list.pairs.size() && !comes_before(c, list.pairs[k]);
    add(c, known ? memory_of(k) : -1);
    if (known) ++k;
  }
  while (k < list.pairs.size()) add_old();
  list = std::move(merged);
}

/// Vertices of a near edges of b.
void Candidates::collect_pair(const Surface& surface, int a, int b, std::vector<Candidate>& found) const {
  const auto ia = at(a), ib = at(b);
  // Positions are those of the last search, which the margins refer to.
  const double margin = margin_[ia] + margin_[ib] + tolerances_.activation,
               deepest = tolerances_.depth_limit + pressed_depth(pressed_, a, b);
  const Box near = box_[ib].grown(margin_[ia] + tolerances_.depth_limit);
  for (int v = surface.block_begin[ia]; v < surface.block_begin[ia + 1]; ++v) {
    const auto iv = at(v);
    const Vec2 p = searched_at_[iv];
    if (surface.is_reflex(iv) || !near.contains(p)) continue;
    for (int e = surface.block_begin[ib]; e < surface.block_begin[ib + 1]; ++e) {
      const auto from = at(e), to = at(surface.next[from]);
      const bool inside = cross(searched_at_[to] - searched_at_[from], p - searched_at_[from]) > 0.0;
      const bool deep = inside || surface.is_concave(from) || surface.is_concave(to);
      const double reach = margin + (deep ? deepest : 0.0);
      if (distance_to_segment(p, searched_at_[from], searched_at_[to]) < reach)
        found.push_back({v, e, a, b, clearance(surface, searched_at_, tolerances_, v, e)});
    }
  }
}

std::vector<Candidate> all_pairs_within(const Surface& surface, double distance) {
  std::vector<Candidate> found;
  for (int v = 0; v < surface.vertices(); ++v) {
    for (int e = 0; e < surface.vertices(); ++e) {
      const auto iv = at(v), ie = at(e);
      const auto a = at(surface.block[iv]), b = at(surface.block[ie]);
      if (a == b || surface.is_reflex(iv) || !surface.present[a] || !surface.present[b] ||
          (surface.fixed[a] && surface.fixed[b]))
        continue;
      if (distance_to_segment(surface.position[iv], surface.position[ie],
                              surface.position[at(surface.next[ie])]) < distance) {
        found.push_back({v, e, surface.block[iv], surface.block[ie]});
      }
    }
  }
  return found;
}

}  // namespace keyblock::contact
