#include "contact/contact_choice.h"

#include "contact/blocking.h"
#include "contact/deep_contacts.h"
#include "contact/entry_face.h"
#include "contact/joint_continuity.h"

namespace keyblock::contact {

namespace {

void leave_out(Competitor& c) {
  c.candidate = -1;
  c.corners = 0;
}

void continue_over_joints(const CornerView& view, const BlockPair& pair, std::span<Competitor> competitors,
                          SteadyMargin& margin) {
  for (Competitor& c : competitors) {
    if (c.memory >= 0 || c.disputed || c.gap >= -view.tolerances.corner_depth) continue;
    const bool counts = take_over_joint(view, pair, competitors, c);
    if (!counts || c.memory >= 0) margin.hangs_on_other_blocks();
    if (!counts) leave_out(c);
  }
}

void leave_out_strangers(const CornerView& view, const BlockPair& pair, std::span<Competitor> competitors,
                         SteadyMargin& margin) {
  for (Competitor& c : competitors) {
    if (c.candidate < 0) continue;
    if (!c.is_beyond && !has_come_in_elsewhere(view, c)) continue;
    margin.hangs_on_other_blocks();
    if (is_out(view, pair, c)) leave_out(c);
  }
}

/// The competitors for the corners of the first, which is among them.
std::size_t find_meeting(std::span<Competitor> from_first,
                         std::array<Competitor*, most_competitors>& meeting) {
  const std::uint64_t corners = from_first[0].corners;
  meeting[0] = from_first.data();
  std::size_t size = 1;
  for (std::size_t k = 1; k < from_first.size() && size < meeting.size(); ++k) {
    if (from_first[k].corners == corners) meeting[size++] = &from_first[k];
  }
  return size;
}

void let_corners_compete(const CornerView& view, const BlockPair& pair, std::span<Competitor> competitors,
                         SteadyMargin& margin) {
  for (std::size_t i = 0; i < competitors.size(); ++i) {
    if (competitors[i].corners == 0) continue;
    std::array<Competitor*, most_competitors> meeting{};
    const std::size_t size = find_meeting(competitors.subspan(i), meeting);
    const auto same = std::span(meeting).first(size);
    const Outcome outcome = compete_among_blocks(view, pair, same);
    margin.take(view, same, outcome);
    for (Competitor* c : same) {
      c->corners = 0;
      const bool is_apart =
          outcome.parallel && !outcome.left_out && inside(view, *c) > view.tolerances.end_zone;
      if (c != outcome.winner && !is_apart && !outcome.each) c->candidate = -1;
    }
  }
}

}  // namespace

void choose_contacts(const SteadyPairs& steady_pairs, const CornerView& view, std::size_t end,
                     std::span<Competitor> competitors, BlockPair& pair) {
  SteadyMargin margin(steady_pairs, view, pair, end, competitors);
  if (pressed_depth(view.pressed, pair.block_a, pair.block_b) > 0.0 ||
      !of_pair(view.deep, at(pair.first), end).empty())
    margin.hangs_on_other_blocks();
  continue_over_joints(view, pair, competitors, margin);
  leave_out_strangers(view, pair, competitors, margin);
  let_corners_compete(view, pair, competitors, margin);
  margin.keep(view, competitors, pair);
}

}  // namespace keyblock::contact
