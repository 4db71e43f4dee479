#include "contact/detection.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>

#include "contact/contact_choice.h"
#include "contact/deep_contacts.h"

namespace keyblock::contact {

namespace {

constexpr std::size_t piece_size = 1'024;         // pairs of blocks
constexpr std::size_t contacts_of_a_cache = 512;  // that a second-level cache has room for

/// A list that grows by some at a time, and keeps its room.
class Growing {
 public:
  explicit Growing(std::vector<FoundContact>& found) : found_(found) {}
  FoundContact* add(std::size_t more) {
    if (count_ + more > found_.size()) found_.resize(std::max(count_ + more, 2 * found_.size()));
    FoundContact* begin = found_.data() + count_;
    count_ += more;
    return begin;
  }
  void finish() { found_.resize(count_); }

 private:
  std::vector<FoundContact>& found_;
  std::size_t count_ = 0;
};

void add_steady(const BlockPair& pair, CandidateList::Finder& memory_of, Growing& found) {
  FoundContact* next = found.add(static_cast<std::size_t>(std::popcount(pair.steady.contacts)));
  for (std::uint64_t left = pair.steady.contacts; left != 0; left &= left - 1, ++next) {
    const int k = std::countr_zero(left);
    next->candidate = pair.first + k;
    next->memory = memory_of(at(next->candidate));
    next->at_corner = (pair.steady.at_corner >> k & 1) != 0;
  }
}

}  // namespace

/// The contacts among the candidates of pairs of blocks [first, last). pairs: of view.candidates, to keep what is steady.
void Detection::find_in_pairs(const CornerView& view, std::span<BlockPair> pairs, std::size_t first,
                              std::size_t last, std::vector<FoundContact>& found) const {
  std::vector<std::size_t> unsteady;
  for (std::size_t p = first; p < last; ++p) {
    // Limits of depth, and which vertices may touch, are others there in this step.
    if (pressed_depth(view.pressed, pairs[p].block_a, pairs[p].block_b) > 0.0 ||
        !of_pair(view.deep, at(pairs[p].first), view.candidates.end_of_pair(p)).empty())
      pairs[p].steady.forget();
    if (!steady_pairs_.is_steady(view.surface, view.motion, pairs[p])) unsteady.push_back(p);
  }
  std::vector<Competitor> competitors;
  find_competitors(view, unsteady, competitors);
  Growing growing(found);
  CandidateList::Finder memory_of(view.candidates, pairs[first].first);
  auto c = competitors.begin();
  auto next_unsteady = unsteady.begin();
  for (std::size_t p = first; p < last; ++p) {
    if (next_unsteady == unsteady.end() || *next_unsteady != p) {
      add_steady(pairs[p], memory_of, growing);
      continue;
    }
    ++next_unsteady;
    const auto next =
        std::find_if(c, competitors.end(), [&](const Competitor& r) { return at(r.pair) != p; });
    choose_contacts(steady_pairs_, view, view.candidates.end_of_pair(p), {c, next}, pairs[p]);
    for (; c != next; ++c) {
      if (c->candidate >= 0) *growing.add(1) = {c->candidate, c->memory, c->disputed};
    }
  }
  growing.finish();
}

void Detection::find(const Surface& surface, const StepMotion& motion, CandidateList& candidates,
                     ThreadTeam& team, std::vector<Contact>& contacts) {
  contacts.resize(find_which(surface, motion, candidates, team));
  describe(surface, candidates, team, contacts);
}

/// Piece by piece of the pairs of blocks, so that the order of what is found is the same whoever finds it.
std::size_t Detection::find_which(const Surface& surface, const StepMotion& motion, CandidateList& candidates,
                                  ThreadTeam& team) {
  corners_.measure(surface, team);
  const std::vector<double> pressed = pressed_depths(candidates, tolerances_, at(surface.blocks()));
  const std::vector<int> deep = deep_contacts(candidates, tolerances_);
  const CornerView view{surface, candidates, tolerances_, motion, corners_.all(), pressed, deep};
  const std::size_t pairs = candidates.block_pairs.size(), pieces = (pairs + piece_size - 1) / piece_size;
  found_.resize(pieces);
  team.for_range(pieces, 2, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      find_in_pairs(view, candidates.block_pairs, p * piece_size, std::min(pairs, (p + 1) * piece_size),
                    found_[p]);
  });
  first_found_.resize(pieces);
  std::size_t total = 0;
  for (std::size_t p = 0; p < pieces; ++p) {
    first_found_[p] = total;
    total += found_[p].size();
  }
  return total;
}

bool Detection::describe_piece(const Surface& surface, const CandidateList& candidates, std::size_t piece,
                               std::span<Contact> contacts, const OfSome& then) const {
  const std::span<const FoundContact> found = found_[piece];
  bool same = true;
  for (std::size_t begin = 0; begin < found.size(); begin += contacts_of_a_cache) {
    const std::size_t end = std::min(found.size(), begin + contacts_of_a_cache);
    for (std::size_t first = begin; first < end; first += lane_count) {
      const std::size_t count = std::min(end - first, std::size_t{lane_count});
      same = description_.describe(surface, corners_, candidates, found.subspan(first, count),
                                   contacts.subspan(first, count)) &&
             same;
    }
    if (then) then(first_found_[piece] + begin, first_found_[piece] + end);
  }
  return same;
}

bool Detection::describe(const Surface& surface, const CandidateList& candidates, ThreadTeam& team,
                         std::span<Contact> contacts, const OfSome& then) const {
  std::atomic<bool> all_same = true;
  team.for_range(found_.size(), 2, [&](std::size_t first_piece, std::size_t last_piece) {
    bool same = true;
    for (std::size_t p = first_piece; p < last_piece; ++p)
      same =
          describe_piece(surface, candidates, p, contacts.subspan(first_found_[p], found_[p].size()), then) &&
          same;
    if (!same) all_same = false;
  });
  return all_same;
}

}  // namespace keyblock::contact
