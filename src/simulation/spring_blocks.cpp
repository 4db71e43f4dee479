#include "simulation/spring_blocks.h"

#include <fmt/format.h>

#include "simulation/history_block.h"
#include "simulation/refuse.h"

namespace keyblock::simulation {

namespace {

std::size_t block_of_end(const RunSetup& setup, const std::string& name, Vec2 end, const std::string& key) {
  if (const auto block = block_at(setup, name, end)) return *block;
  const Vec2 p = end + setup.system.origin;
  refuse(key, fmt::format("[{}, {}], outside", p.x, p.y),
         name.empty() ? "a point of a block" : fmt::format("a point of the block '{}'", name));
}

}  // namespace

SpringBlocks spring_blocks(const RunSetup& setup, std::size_t k) {
  const loading::Spring& spring = setup.springs[k];
  const std::string key = fmt::format("spring[{}]", k);
  const SpringBlocks blocks{block_of_end(setup, spring.from_block, spring.from, key + ".from"),
                            block_of_end(setup, spring.to_block, spring.to, key + ".to")};
  if (blocks.from == blocks.to)
    refuse(key + ".to", "a point of the block of from", "a point of another block");
  if (setup.properties[blocks.from].fixed && setup.properties[blocks.to].fixed)
    refuse(key + ".to", "a point of a fixed block, as from is", "a block that moves at one end");
  return blocks;
}

}  // namespace keyblock::simulation
