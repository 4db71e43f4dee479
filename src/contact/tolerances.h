#pragma once

namespace keyblock::contact {

/// Lengths of the contact geometry. All scale with the block size ℓ = √(mean block area), so that a model in any unit and
/// of any size meets the same rules; the comment gives the share of ℓ and the value at ℓ = 0.67 m (a jointed tunnel).
struct Tolerances {
  explicit Tolerances(double block_size)
      : activation(0.0015 * block_size),
        end_zone(0.003 * block_size),
        depth_limit(0.03 * block_size),
        margin(0.015 * block_size),
        least_length(0.05 * block_size),
        corner_tie(0.00075 * block_size),
        corner_depth(0.00015 * block_size),
        in_place(1e-4 * block_size),
        rounding(1e-6 * block_size),
        turn(5e-5 * block_size) {}

  /// A gap below which a contact takes part in the step although it is open (1 mm); motion adds to it. Too small:
  /// a contact is met only after it has been penetrated. Too large: more contacts to evaluate.
  double activation;
  /// Distance from the end of an edge within which the contacts of two corners compete (2 mm); motion adds to it.
  double end_zone;
  /// Depth up to which a vertex behind an edge is in contact with it (2 cm). Must stay below the thickness of a block:
  /// beyond it a vertex is grabbed by the far edge. Also how far an edge reaches past an end in a concave corner (CornerKind), where a
  /// vertex of another block may slip by. A block of area A and perimeter P has A/P, should that be less.
  double depth_limit;
  /// How far candidates are collected beyond the activation distance (1 cm), each block on its own. Larger: fewer
  /// rebuilds, more candidates.
  double margin;
  /// Least length of joint that gives a contact its stiffness (3 cm): a corner on an edge has no length of its own. Edges that face each
  /// other may have less.
  double least_length;
  /// Two corners tip to tip: while the gaps to their two entrance lines differ by less than `corner_tie` (0.5 mm), and the corners
  /// are not deeper than `corner_depth` (0.1 mm) behind one nor go there in the step, there is no telling which side they pass, and
  /// no contact; unless the lines part them alike (`cosine_alike`).
  double corner_tie;
  double corner_depth;
  /// Largest gap of a joint in place at the start (0.07 mm): such a contact has the joint's cohesion and tension.
  double in_place;
  /// Corners that miss each other by less still meet (0.7 µm): outlines may be given to few digits.
  double rounding;

  /// Of the gap at the end of a step, what a contact may miss as its blocks turn and leave the straight path that the step is linear
  /// in (0.03 mm). Beyond, or where it costs more work than it may (dynamics::RotationCorrection), the step is taken again with what it
  /// missed. Larger: small spinning blocks are pressed into others by the rotation and thrown out again.
  double turn;

  /// A vertex touches an edge only when both its own edges lie outside it, up to this angle (sin 2°).
  static constexpr double sine_inside = 0.0349;
  /// Of the least length, what is enough for one of several contacts between edges that share twice that or more: the others hold them.
  static constexpr double least_of_many = 0.02;
  /// Entrance lines within this angle are one line (sin 4°).
  static constexpr double sine_parallel = 0.0698;
  /// Entrance lines within this angle part two corners the same way (cos 30°): which of them is taken does not matter.
  static constexpr double cosine_alike = 0.866;
  /// Edges within this angle share a length of joint (sin 5°), as far as they are no more than `activation` apart.
  static constexpr double sine_facing = 0.0872;
};

}  // namespace keyblock::contact
