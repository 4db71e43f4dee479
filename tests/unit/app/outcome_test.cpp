#include "outcome.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace keyblock::app {
namespace {

using record::RunRecord;
using record::StageKind;
using record::StageRecord;
using ::testing::HasSubstr;
using ::testing::Not;

RunRecord settled_and_shaken() {
  RunRecord run;
  run.steps = 2000;
  run.wall_time = 5.0;
  run.dof = 5502;
  run.state_hash = "00ff";
  run.open_close.mean_iterations = 3.25;
  run.max_overlap.depth = 4e-4;
  StageRecord settled;
  settled.stage.name = "in situ";
  settled.equilibrium_reached = true;
  settled.steps = 120;
  StageRecord shaken;
  shaken.stage.name = "first earthquake";
  shaken.stage.kind = StageKind::shake;
  shaken.steps = 1880;
  shaken.duration = 3.76;
  shaken.pga = 1.25;
  shaken.damage.fallen_blocks = 12;
  shaken.damage.fallen_area = 3.5;
  shaken.damage.slip_max_ever = 0.0125;
  shaken.damage.opening_filled_ratio = 0.147;
  run.stages = {settled, shaken};
  return run;
}

TEST(OutcomeText, OneAlignedRowPerStage) {
  const std::string text = outcome_text(settled_and_shaken(), 917);
  EXPECT_THAT(text, HasSubstr("917 blocks, 5502 degrees of freedom; 2000 steps in 5.0 s: 2.50 ms"));
  EXPECT_THAT(text, HasSubstr("largest overlap 0.400 mm"));
  EXPECT_THAT(text, HasSubstr("\nstage             steps  time   PGA  fallen  fallen"));
  EXPECT_THAT(text, HasSubstr("\nin situ             120     -     -       0    0.00"));
  EXPECT_THAT(text, HasSubstr("\nfirst earthquake   1880  3.76  1.25      12    3.50"));
  EXPECT_THAT(text, HasSubstr("    14.7  12.50\n"));
  EXPECT_THAT(text, Not(HasSubstr("note:")));
}

TEST(OutcomeText, TheTableFitsATerminal) {
  RunRecord run = settled_and_shaken();
  run.stages[1].stage.name = "a stage whose name is long";
  run.stages[1].steps = 1234567;
  run.stages[1].damage.slip_max_ever = 2479.2;
  const std::string text = outcome_text(run, 917);
  const std::size_t from = text.find("\nstage ") + 1, to = text.find("12.50\n", from);
  std::istringstream lines(text.substr(from, text.find("1234567") + 80 - from));
  std::string line;
  for (int k = 0; k < 4 && std::getline(lines, line); ++k)
    EXPECT_LE(line.size(), 82U) << line;  // … has three bytes
  EXPECT_EQ(to, std::string::npos);
}

TEST(OutcomeText, GravityIsNotTheEarthquake) {
  RunRecord run = settled_and_shaken();
  run.stages[0].stage.excavate = {0};
  run.stages[0].damage.fallen_blocks = 1;
  run.stages[0].damage.fallen_area = 0.75;
  EXPECT_THAT(
      outcome_text(run, 9),
      HasSubstr("fallen before the shaking: 1 block (0.75 m2); the shaking added 11 blocks (2.75 m2)\n"));
  run.stages[1].stage.kind = StageKind::rest;
  EXPECT_THAT(outcome_text(run, 9), Not(HasSubstr("before the shaking")));
}

TEST(OutcomeText, SaysWhatToBeWaryOf) {
  RunRecord run = settled_and_shaken();
  run.stages[0].equilibrium_reached = false;
  run.stages[0].worst_residual_ratio = 0.05;
  EXPECT_THAT(outcome_text(run, 9),
              HasSubstr("note: stage \"in situ\" ended before equilibrium: worst residual 5.0e-02"));
  run.max_overlap = {6.895e-3, 347, 552, {1.36, -2.39}, 1.0, "first earthquake"};
  EXPECT_THAT(
      outcome_text(run, 9),
      HasSubstr("note: blocks 347 and 552 overlap by 6.9 mm at 1.00 s, in stage \"first earthquake\": "
                "a smaller time step, or stiffer joints, may help\n"));
  run.stages[0].equilibrium_reached = true;
  run.stages[0].moving = {{17, 0.25}};
  EXPECT_THAT(outcome_text(run, 9),
              HasSubstr("note: stage \"in situ\": 1 block moving (share of the weight that is "
                        "carried: block 17 25 %)\n"));
  run.stages[0].moving.resize(9, {18, 0.5});
  EXPECT_THAT(outcome_text(run, 9), HasSubstr("9 blocks moving"));
  EXPECT_THAT(outcome_text(run, 9), HasSubstr("block 18 50 %, ...)\n"));
  run.stages[1].interrupted = true;
  run.open_close.unconverged_steps = 3;
  EXPECT_THAT(outcome_text(run, 9),
              HasSubstr("note: stage \"first earthquake\" was interrupted\nnote: 3 steps did not"));
}

TEST(OutcomeText, SaysThatARestWasTooShort) {
  RunRecord run = settled_and_shaken();
  run.stages[0].stage.kind = StageKind::rest;
  run.stages[0].stage.until_still = true;
  run.stages[0].duration = 0.1;
  EXPECT_THAT(outcome_text(run, 45), HasSubstr("ended after 0.1 s while rock still moved"));
  run.stages[0].still = true;
  EXPECT_THAT(outcome_text(run, 45), Not(HasSubstr("while rock still moved")));
}

TEST(OutcomeText, SaysWhatFellAndFromWhere) {
  RunRecord run = settled_and_shaken();
  record::Damage& damage = run.stages[1].damage;
  damage.fallen_weight = 91.2e3;
  damage.largest_block_pressure = 15.2e3;
  damage.largest_fallen_weight = 30.5e3;
  damage.fallen_depth = damage.fallen_depth_crown = 1.234;
  damage.fallen_depth_right = 0.4;
  const std::string text = outcome_text(run, 9, "tunnel.toml", std::vector<std::string>{"adit"});
  EXPECT_THAT(text, HasSubstr("\nfallen: 91.2 kN per m of tunnel; largest block 30.5 kN/m, 15.2 kPa over its "
                              "own width; from behind the crown 1.23 m, right wall 0.40 m\n"));
  EXPECT_THAT(text, HasSubstr("\nthe support pressure that holds it: keyblock limit tunnel.toml --key "
                              "excavation.adit.pressure --from 2e+05 --to 0 -o pressure\n"));
  damage.fallen_blocks = 0;
  EXPECT_THAT(outcome_text(run, 9), Not(HasSubstr("fallen:")));
}

TEST(OutcomeText, SaysWhetherItStands) {
  RunRecord run = settled_and_shaken();
  StageRecord& last = run.stages[1];
  last.standing = record::Standing::collapsed;
  last.damage.displacement_max = 1.5;
  last.damage.rotation_max = 178.2;
  EXPECT_THAT(
      outcome_text(run, 9),
      HasSubstr("\nat the end of \"first earthquake\" it has collapsed: 12 blocks have fallen; the middle of "
                "a block has moved by up to 1.5 m, and a block turned by up to 178 degrees\n"));
  last.standing = record::Standing::moves;
  last.largest_speed = 0.25;
  EXPECT_THAT(outcome_text(run, 9), HasSubstr("it moves, at up to 0.25 m/s; the middle"));
  last.standing = record::Standing::stands;
  EXPECT_THAT(outcome_text(run, 9), HasSubstr("\" it stands; the middle"));
  last.damage.rotation_max = 1e-13;
  EXPECT_THAT(outcome_text(run, 9), HasSubstr("turned by up to 0 degrees"));
}

TEST(OutcomeText, NothingIsFilledWithoutAnOpening) {
  RunRecord run = settled_and_shaken();
  run.stages[1].damage.opening_filled_ratio = 0.125;
  EXPECT_THAT(outcome_text(run, 9), HasSubstr(" 12.5 "));
  run.stages[1].standing = record::Standing::stands;
  EXPECT_THAT(outcome_text(run, 9), Not(HasSubstr(" 12.5 ")));
}

TEST(OutcomeText, OfARunThatDidNothing) {
  EXPECT_THAT(outcome_text({}, 0), HasSubstr("0 steps in 0.0 s: 0.00 ms"));
}

}  // namespace
}  // namespace keyblock::app
