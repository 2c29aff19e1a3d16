// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/servo_loops.h>

#include <map>

namespace oblique::draw::schematic {
namespace {

/// What is reached from `start` along `next` without going through what `ends` marks.
std::vector<bool> reached(std::size_t start, const std::vector<std::vector<std::size_t>>& next,
                          const std::vector<bool>& ends) {
  std::vector<bool> seen(next.size());
  std::vector<std::size_t> stack{start};
  while (!stack.empty()) {
    const std::size_t at = stack.back();
    stack.pop_back();
    for (const std::size_t to : next[at]) {
      if (seen[to]) continue;
      seen[to] = true;
      if (!ends[to]) stack.push_back(to);
    }
  }
  return seen;
}

}  // namespace

void find_servo_loops(Schematic& schematic) {
  const std::size_t n = schematic.blocks.size();
  std::vector<std::vector<std::size_t>> next(n), before(n);
  std::vector<bool> ends(n);
  for (std::size_t b = 0; b < n; ++b) {
    const diagram::BlockDefinition* const definition = schematic.blocks[b].definition;
    ends[b] = definition != nullptr &&
              (definition->symbol == "open-amplifier" || definition->symbol == "integrator");
    for (const Input& input : schematic.blocks[b].inputs) {
      if (!input.signal) continue;
      next[input.signal->block].push_back(b);
      before[b].push_back(input.signal->block);
    }
  }
  for (std::size_t b = 0; b < n; ++b) {
    const diagram::BlockDefinition* const definition = schematic.blocks[b].definition;
    if (definition == nullptr || definition->symbol != "open-amplifier") continue;
    const std::vector<bool> after = reached(b, next, ends), ahead = reached(b, before, ends);
    if (!after[b]) continue;
    const std::size_t loop = schematic.loops++;
    for (std::size_t k = 0; k < n; ++k) {
      const bool on_the_way = after[k] && ahead[k] && !ends[k];
      if (k == b || (on_the_way && !schematic.blocks[k].loop)) schematic.blocks[k].loop = loop;
    }
  }
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> nets;
  for (Block& block : schematic.blocks) {
    for (Input& input : block.inputs) {
      input.in_loop = input.signal && block.loop && schematic.blocks[input.signal->block].loop == block.loop;
      if (input.in_loop) nets[{input.signal->block, input.signal->output}] = *block.loop;
    }
  }
  for (Block& block : schematic.blocks) {
    for (Input& input : block.inputs) {
      if (!input.signal) continue;
      const auto net = nets.find({input.signal->block, input.signal->output});
      if (net != nets.end()) input.loop = net->second;
    }
  }
}

}  // namespace oblique::draw::schematic
