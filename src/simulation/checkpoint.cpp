#include "simulation/checkpoint.h"

#include <fmt/format.h>

#include <type_traits>
#include <utility>

#include "core/archive.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/index.h"
#include "record/stage_fields.h"

namespace keyblock::simulation {

namespace {

constexpr std::uint64_t format = 0x6b65'7962'6c6b'001d;

std::uint64_t fingerprint(const RunSetup& setup) {
  Hash hash;
  hash.add(setup.version.data(), setup.version.size());
  hash.add(setup.scenario.data(), setup.scenario.size());
  for (const InputFile& file : setup.files) {
    hash.add(file.name.data(), file.name.size());
    hash.add(file.hash.data(), file.hash.size());
  }
  const double numbers[] = {static_cast<double>(setup.seed), static_cast<double>(setup.realization),
                            setup.time_step, static_cast<double>(setup.system.blocks.size()),
                            static_cast<double>(setup.stages.size())};
  hash.add(numbers, sizeof(numbers));
  return hash.value();
}

template <typename Archive, typename WaitOrConst>
void transfer_wait(Archive& archive, WaitOrConst& s) {
  record::StageWait wait = s.value_or(record::StageWait{});
  archive(wait.what);
  archive(wait.until);
  if constexpr (!std::is_const_v<WaitOrConst>) {
    if (!wait.what.empty()) s = wait;
  }
}

template <typename Archive, typename StageRecordOrConst>
void transfer_stage(Archive& archive, StageRecordOrConst& s) {
  record::visit_stage(s, [&](const record::StageField&, auto& value) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, std::optional<record::StageWait>>)
      transfer_wait(archive, value);
    else
      archive(value);
  });
}

template <typename Archive, typename StateOrConst>
void transfer_mechanics(Archive& archive, StateOrConst& s) {
  archive(s.time);
  archive(s.step);
  archive(s.last_step);
  archive(s.position);
  archive(s.velocity);
  archive(s.acceleration);
  archive(s.force);
  archive(s.acceleration_known);
  archive(s.moved);
  archive(s.contacts.pairs);
  archive(s.contacts.tracked);
  archive(s.contacts.memory);
  archive(s.contacts.pieces);
  archive(s.pattern);
  archive(s.couplings);
  archive(s.walls.forces);
  archive(s.walls.released);
  archive(s.walls.pressure);
  archive(s.walls.left);
  archive(s.installed);
  archive(s.ledger);
  archive(s.contact_energy);
  archive(s.support_energy);
}

template <typename Archive, typename MemoryOrConst>
void transfer_opening(Archive& archive, MemoryOrConst& s) {
  archive(s.part);
  archive(s.before);
  archive(s.start);
  archive(s.points);
}

template <typename Archive, typename MemoryOrConst>
void transfer_damage(Archive& archive, MemoryOrConst& s) {
  archive(s.reference.open);
  archive(s.reference.start);
  archive(s.reference.turn);
  archive(s.reference.base);
  archive(s.reference.of_stage);
  archive(s.reference.height);
  archive(s.reference.width);
  archive(s.pieces);
}

template <typename Archive, typename MemoryOrConst>
void transfer_settler(Archive& archive, MemoryOrConst& s) {
  archive(s.time_step);
  archive(s.creep);
  archive(s.steps);
  archive(s.quiet_steps);
  archive(s.first_ratio);
  archive(s.worst_ratio);
  archive(s.best_predicted);
  archive(s.since_best);
  archive(s.wait);
  archive(s.trial_acceleration);
  archive(s.inertia_scale);
  archive(s.blocks.travel_limit);
  archive(s.blocks.travel);
  archive(s.blocks.nearest);
  archive(s.blocks.carried);
  archive(s.blocks.astray);
  archive(s.blocks.state);
  archive(s.blocks.candidates);
}

template <typename Archive, typename OverlapOrConst>
void transfer_overlap(Archive& archive, OverlapOrConst& overlap) {
  archive(overlap.depth);
  archive(overlap.block_a);
  archive(overlap.block_b);
  archive(overlap.where);
  archive(overlap.time);
  archive(overlap.stage);
}

template <typename Archive, typename RunStateOrConst>
void transfer(Archive& archive, RunStateOrConst& s) {
  transfer_mechanics(archive, s.mechanics);
  archive(s.present);
  archive(s.orders.orders);
  archive(s.orders.lowered);
  transfer_opening(archive, s.opening);
  transfer_damage(archive, s.damage);
  transfer_settler(archive, s.settler);
  archive(s.still.since);
  archive(s.still.places);
  archive(s.control.strengths);
  archive(s.control.load_scale);
  archive(s.control.motion_scale);
  archive(s.control.forces);
  archive(s.control.spring_stiffness);
  archive(s.peaks);
  archive(s.control.contact_strengths);
  archive(s.stage);
  archive(s.stage_step);
  archive(s.stage_start);
  archive(s.initial_energy);
  archive(s.wall_time);
  archive(s.iterations);
  archive(s.reported.frames);
  archive(s.reported.contacts);
  archive(s.reported.histories);
  archive(s.reported.breaks);
  archive(s.reported.steps);
  archive(s.reported.stages);
  archive(s.reported.within_stage);
  archive(s.record.open_close);
  transfer_overlap(archive, s.record.max_overlap);
  archive(s.record.contact_checks.across_gaps);
  transfer_overlap(archive, s.record.contact_checks.farthest);
  transfer_overlap(archive, s.record.contact_checks.deepest);
  transfer_overlap(archive, s.record.contact_checks.unexplained);
  archive(s.record.max_area_change);
  archive(s.record.made);
  archive(s.record.breaks);
}

RunState read_state(ArchiveReader& archive, const RunSetup& setup) {
  RunState state;
  transfer(archive, state);
  std::uint64_t stages = 0;
  archive(stages);
  if (stages > setup.stages.size()) throw ArchiveError();
  state.record.stages.resize(stages);
  for (record::StageRecord& stage : state.record.stages) transfer_stage(archive, stage);
  if (!archive.at_end()) throw ArchiveError();
  return state;
}

}  // namespace

std::filesystem::path checkpoint_path(const std::filesystem::path& directory) {
  return directory / "checkpoint.bin";
}

void write_checkpoint(const std::filesystem::path& directory, const RunSetup& setup, const RunState& state) {
  AtomicFile file(checkpoint_path(directory));
  ArchiveWriter archive(file);
  archive(format);
  archive(fingerprint(setup));
  transfer(archive, state);
  archive(static_cast<std::uint64_t>(state.record.stages.size()));
  for (const record::StageRecord& stage : state.record.stages) transfer_stage(archive, stage);
  archive.finish();
  file.commit();
}

void refuse_checkpoint(const std::filesystem::path& directory, std::string found, std::string expected) {
  Diagnostic diagnostic;
  diagnostic.where.file = checkpoint_path(directory).string();
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  diagnostic.hint = "to begin anew, run into another folder";
  throw InputError(std::move(diagnostic));
}

RunState read_checkpoint(const std::filesystem::path& directory, const RunSetup& setup) {
  const std::string data = read_file(checkpoint_path(directory), any_size);
  std::uint64_t number = 0;
  if (data.size() < 3 * sizeof(number)) refuse_checkpoint(directory, "a truncated file", "a checkpoint");
  const std::string_view content(data.data(), data.size() - sizeof(number));
  Hash hash;
  hash.add(content.data(), content.size());
  ArchiveReader(std::string_view(data).substr(content.size()))(number);
  if (number != hash.value()) refuse_checkpoint(directory, "a damaged file", "a checkpoint");
  ArchiveReader archive(content);
  archive(number);
  if (number != format) refuse_checkpoint(directory, "another format", "a checkpoint of this version");
  archive(number);
  if (number != fingerprint(setup)) {
    refuse_checkpoint(directory, "the checkpoint of another scenario, realization or version",
                      "one of the run to be resumed");
  }
  try {
    return read_state(archive, setup);
  } catch (const ArchiveError&) {
    refuse_checkpoint(directory, "a file that ends elsewhere than its counts say", "a checkpoint");
  }
}

std::string state_hash(const dynamics::State& state) {
  Hash hash;
  hash.add(state.position);
  hash.add(state.velocity);
  for (std::size_t k = 0; k < state.contacts.tracked.size(); ++k) {
    const contact::Candidate& c = state.contacts.pairs[at(state.contacts.tracked[k])];
    const contact::Memory& memory = state.contacts.memory[k];
    const double numbers[] = {
        static_cast<double>(c.vertex), static_cast<double>(c.edge),      memory.offset, memory.shear,
        memory.normal_force,           static_cast<double>(memory.state)};
    hash.add(numbers, sizeof(numbers));
  }
  return fmt::format("{:016x}", hash.value());
}

}  // namespace keyblock::simulation
