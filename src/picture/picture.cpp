#include "picture/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/index.h"
#include "picture/force_chains.h"
#include "picture/layers.h"
#include "picture/legend.h"
#include "picture/marks.h"

namespace keyblock::picture {
namespace {

constexpr double page_width = 1280.0, legend_width = 270.0, edge = 24.0, head = 70.0, foot = 56.0;
constexpr double most_height = 860.0, least_height = 520.0;
constexpr int font_size = 15;

double mean_block_size(const record::ModelRecord& model) {
  double area = 0.0;
  int count = 0;
  for (const auto& block : model.blocks) {
    if (block.fixed) continue;
    area += block.area;
    ++count;
  }
  return count == 0 ? 1.0 : std::sqrt(area / count);
}

std::vector<Vec2> velocities(const record::Frame& frame) {
  std::vector<Vec2> found;
  for (const auto& [x, y] : frame.velocity) found.push_back({x, y});
  return found;
}

}  // namespace

class SectionPicture::Parts {
 public:
  Parts(const results::RunData& run, Options options)
      : run_(run),
        options_(std::move(options)),
        values_(run, *find_quantity(options_.color)),
        locator_(run.model),
        block_size_(mean_block_size(run.model)) {
    view_.window = window_of(run);
    const double room = page_width - 2.0 * edge - legend_width;
    const Vec2 size = view_.window.size();
    view_.scale = std::min(room / size.x, most_height / size.y);
    view_.left = edge + 0.5 * (room - view_.width());
    view_.top = head;
    measure();
  }

  [[nodiscard]] std::string draw(std::size_t frame) const {
    const Placement place(run_, run_.frames[frame], options_.exaggeration);
    const Canvas canvas{run_, view_, place, block_size_};
    std::string svg = svg_begin(page_width, height(), font_size);
    svg += heading(frame);
    svg += fmt::format(
        "<clipPath id=\"section\"><rect x=\"{0:.2f}\" y=\"{1:.2f}\" width=\"{2:.2f}\" "
        "height=\"{3:.2f}\"/></clipPath>\n"
        "<rect x=\"{0:.2f}\" y=\"{1:.2f}\" width=\"{2:.2f}\" height=\"{3:.2f}\" fill=\"none\" "
        "stroke=\"#bbbbbb\"/>\n"
        "<g clip-path=\"url(#section)\">\n",
        view_.left, view_.top, view_.width(), view_.height());
    svg += layers(canvas, frame);
    svg += "</g>\n" + scale_bar() + legend();
    return svg.append(svg_end);
  }

  [[nodiscard]] std::string file_name(std::size_t frame) const {
    return fmt::format("{}-{}-{:.3f}s", file_word(run_.model.title), options_.color, run_.frames[frame].time);
  }

 private:
  // Even, as films want it.
  [[nodiscard]] double height() const {
    return 2.0 * std::ceil(0.5 * (head + std::max(view_.height(), least_height) + foot));
  }

  void measure() {
    for (const std::size_t f : stage_end_frames(run_)) {
      measure_joints(f);
      for (std::size_t k = 0; k < run_.frames[f].elements.size(); ++k)
        if (!std::isfinite(run_.model.elements[k].limit))
          largest_free_ = std::max(largest_free_, std::abs(run_.frames[f].elements[k].force));
    }
    joint_scale_ = scale_of_joints(largest_at_joints_);
    if (needs_forces() || options_.stress || options_.arrows != "none") typical_ = typical_sizes(run_);
  }

  void measure_joints(std::size_t frame) {
    const auto* contacts = contacts_at(run_, frame);
    if (contacts == nullptr) return;
    for (const record::ContactRecord& c : contacts->contacts)
      if (c.label.kind != cutting::EdgeKind::domain)
        largest_at_joints_ = std::max(largest_at_joints_, options_.joints == "opening" ? c.gap : c.slip());
  }

  [[nodiscard]] bool needs_forces() const { return options_.forces || options_.thrust; }

  [[nodiscard]] std::vector<Vec2> arrows_of(std::size_t frame) const {
    return options_.arrows == "velocity" ? velocities(run_.frames[frame]) : block_displacements(run_, frame);
  }

  [[nodiscard]] std::string layers(const Canvas& canvas, std::size_t frame) const {
    std::string svg = draw_fixed(canvas) + draw_blocks(canvas, values_, values_.at(frame));
    if (options_.outline) svg += draw_before(canvas);
    svg += draw_excavations(canvas);
    const record::ContactFrame* contacts = contacts_at(run_, frame);
    if (options_.joints == "set")
      svg += draw_joint_sets(canvas);
    else if (options_.joints != "none" && contacts != nullptr)
      svg += joints(canvas, *contacts);
    if (options_.forces && contacts != nullptr) svg += draw_forces(canvas, *contacts, typical_.force);
    if (options_.stress) svg += draw_crosses(canvas, typical_.stress);
    svg += draw_elements(canvas, largest_free_);
    if (options_.arrows != "none") svg += draw_arrows(canvas, arrows_of(frame), typical_.of(options_.arrows));
    if (options_.thrust && contacts != nullptr) svg += draw_thrust(canvas, *contacts, typical_.force);
    return svg;
  }

  [[nodiscard]] std::string joints(const Canvas& canvas, const record::ContactFrame& contacts) const {
    std::vector<results::JointPiece> pieces;
    locator_.locate(contacts.contacts, run_.frames[results::frame_of(contacts, run_.frames)].displacement,
                    pieces);
    if (options_.joints == "state") return draw_states(canvas, pieces);
    return draw_sizes(canvas, pieces, options_.joints == "slip", joint_scale_);
  }

  [[nodiscard]] std::string heading(std::size_t f) const {
    const record::Frame& frame = run_.frames[f];
    const auto& names = run_.model.stage_names;
    std::string when = at(frame.stage) < names.size() ? names[at(frame.stage)] + ", " : "";
    when += fmt::format("t = {:.3f} s", frame.time);
    const auto* contacts = contacts_at(run_, f);
    const bool shows_contacts = needs_forces() || options_.joints == "state" || options_.joints == "slip" ||
                                options_.joints == "opening";
    if (shows_contacts && contacts == nullptr)
      when += "; no contacts are kept up to then";
    else if (shows_contacts && contacts->step != frame.step)
      when += fmt::format("; contacts of {:.3f} s", contacts->time);
    if (options_.exaggeration != 1.0) when += fmt::format("; displacements × {:g}", options_.exaggeration);
    return svg_text(edge, 30.0, "start", run_.model.title, "font-weight=\"bold\" font-size=\"19\"") +
           svg_text(edge, 54.0, "start", when);
  }

  [[nodiscard]] std::string scale_bar() const {
    const double length = nice_below(0.2 * view_.window.size().x), y = view_.top + view_.height() + 20.0;
    return fmt::format(
               "<path fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" d=\"M{:.2f} {:.2f}v8h{:.2f}v-8\"/>\n",
               ink_color, view_.left, y - 6.0, view_.scale * length) +
           svg_text(view_.left + view_.scale * length + 10.0, y + 4.0, "start",
                    with_unit(length, Quantity::length));
  }

  [[nodiscard]] std::string legend() const {
    LegendColumn column(page_width - legend_width, head - 10.0);
    const BlockQuantity& quantity = values_.quantity();
    if (!quantity.is_class)
      column.bar(quantity.title, values_.scale(), quantity.quantity, quantity.map, quantity.much_is_low);
    else if (std::string_view(quantity.name) != "plain")
      column.classes(quantity.title, values_.classes(), false);
    if (quantity.much_is_low) column.note("compression is negative");
    if (options_.joints == "set") column.classes("Joints by set", set_colors(run_.model), true);
    if (options_.joints == "state") column.classes("State of the joints", state_colors(), true);
    if (options_.joints == "slip" || options_.joints == "opening")
      column.bar(options_.joints == "slip" ? "Slip of the joints" : "Opening of the joints", joint_scale_,
                 Quantity::length, ColorMap::viridis, false);
    element_legend(column);
    mark_legend(column);
    return column.svg();
  }

  void element_legend(LegendColumn& column) const {
    if (run_.model.elements.empty()) return;
    column.line(shade(ColorMap::viridis, shades - 1), 6.0, 30.0, "element at its limit");
    column.line(shade(ColorMap::viridis, shades / 2), 4.0, 30.0, "at half of it");
    if (largest_free_ > 0.0)
      column.note("without a limit: of the largest, " + with_unit(largest_free_, Quantity::force));
  }

  void mark_legend(LegendColumn& column) const {
    if (options_.forces) {
      const double force = nice_above(0.6 * typical_.force);
      column.line(force_color, mark_of("forces").drawn * force / typical_.force, 30.0,
                  "force between blocks: " + with_unit(force, Quantity::force));
    }
    const auto length = [&](double sides, double share) { return sides * share * block_size_ * view_.scale; };
    if (options_.stress) {
      const double stress = nice_above(0.6 * typical_.stress);
      column.line(compression_color, 1.5, length(mark_of("stress").drawn, stress / typical_.stress),
                  "compression of " + with_unit(stress, Quantity::stress));
      column.line(tension_color, 1.5, length(mark_of("stress").drawn, stress / typical_.stress),
                  "tension, the same");
    }
    if (options_.arrows != "none") {
      const Quantity of = options_.arrows == "velocity" ? Quantity::velocity : Quantity::length;
      const double size = nice_above(0.6 * typical_.of(options_.arrows));
      column.line(arrow_color, 1.6,
                  length(mark_of(options_.arrows).drawn, size / typical_.of(options_.arrows)),
                  fmt::format("{} of {}; cut at {}", options_.arrows, with_unit(size, of),
                              with_unit(longest_arrow * typical_.of(options_.arrows), of, 2)));
    }
    if (options_.thrust) {
      column.line(outline_color, 2.5, 30.0, "line of thrust");
      column.line(outline_color, 10.0, 10.0, "hinge: the force is at the end of the joint");
    }
    if (options_.outline) column.line("#0072b2", 0.8, 30.0, "as the blocks were");
    if (!run_.model.excavation_outlines.empty())
      column.line(outline_color, 1.6, 30.0, "excavation as planned");
  }

  const results::RunData& run_;
  Options options_;
  BlockValues values_;
  results::JointLocator locator_;
  View view_;
  Typical typical_;
  double block_size_;
  double largest_free_ = 0.0;       ///< N per thickness, of elements without a limit
  double largest_at_joints_ = 0.0;  ///< m
  Scale joint_scale_;
};

SectionPicture::SectionPicture(const results::RunData& run, Options options)
    : parts_(std::make_unique<Parts>(run, std::move(options))) {}

SectionPicture::~SectionPicture() = default;

std::string SectionPicture::draw(std::size_t frame) const {
  return parts_->draw(frame);
}

std::string SectionPicture::file_name(std::size_t frame) const {
  return parts_->file_name(frame);
}

std::size_t frame_near(const results::RunData& run, double time) {
  std::size_t nearest = 0;
  for (std::size_t f = 0; f < run.frames.size(); ++f)
    if (std::abs(run.frames[f].time - time) <= std::abs(run.frames[nearest].time - time)) nearest = f;
  return nearest;
}

std::string file_word(std::string_view title) {
  constexpr std::size_t longest = 40;
  std::string word;
  for (const char letter : title) {
    const auto c = static_cast<unsigned char>(letter);
    if (c < 128 && std::isalnum(c) != 0)
      word += static_cast<char>(std::tolower(c));
    else if (!word.empty() && word.back() != '-')
      word += '-';
    if (word.size() == longest) break;
  }
  while (!word.empty() && word.back() == '-') word.pop_back();
  return word.empty() ? "section" : word;
}

}  // namespace keyblock::picture
