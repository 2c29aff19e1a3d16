// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/assur_class.h>

#include <algorithm>
#include <queue>

namespace oblique::mechanism {
int order_of(const Mechanism& mechanism, const GroupMembers& members, const std::vector<bool>& known) {
  int pairs = 0;
  for (const std::size_t body : members.bodies) {
    for (const BodyPoint& p : mechanism.bodies[body].points) pairs += known[p.point] ? 1 : 0;
  }
  for (const std::size_t s : members.slides) {
    const Slide& slide = mechanism.slides[s];
    if (!slide.carrier || !has(members.bodies, *slide.carrier))
      ++pairs;
    else if (!slide.of && known[slide.point])
      ++pairs;
    else if (slide.of && !has(members.bodies, *slide.of))
      ++pairs;
  }
  return pairs;
}

int class_of(const Mechanism& mechanism, const GroupMembers& members, const std::vector<bool>& known) {
  struct Pair {
    std::vector<std::size_t> bodies;  ///< of the group
    int others;                       ///< elements outside of it
  };
  std::vector<Pair> pairs;
  for (std::size_t point = 0; point < mechanism.points.size(); ++point) {
    Pair pair{{}, known[point] ? 1 : 0};
    for (const std::size_t body : members.bodies) {
      if (mechanism.bodies[body].find(point) != nullptr) pair.bodies.push_back(body);
    }
    if (!pair.bodies.empty() && pair.bodies.size() + static_cast<std::size_t>(pair.others) >= 2)
      pairs.push_back(std::move(pair));
  }
  for (const std::size_t s : members.slides) {
    const Slide& slide = mechanism.slides[s];
    Pair pair{{}, 0};
    if (slide.carrier && has(members.bodies, *slide.carrier)) pair.bodies.push_back(*slide.carrier);
    for (const std::size_t body : members.bodies) {
      const bool guided = slide.of ? *slide.of == body : mechanism.bodies[body].find(slide.point) != nullptr;
      if (guided) {
        pair.bodies.push_back(body);
        break;
      }
    }
    pairs.push_back(std::move(pair));
  }
  int largest = 2;
  for (const std::size_t body : members.bodies) {
    const auto count =
        std::count_if(pairs.begin(), pairs.end(), [&](const Pair& p) { return has(p.bodies, body); });
    largest = std::max(largest, static_cast<int>(count));
  }
  // shortest loop through link `from` and pair `cut`: a breadth-first search that does not use the pair
  for (std::size_t cut = 0; cut < pairs.size(); ++cut) {
    for (std::size_t i = 1; i < pairs[cut].bodies.size(); ++i) {
      std::vector<int> steps(mechanism.bodies.size(), 0);
      std::queue<std::size_t> queue;
      steps[pairs[cut].bodies[i]] = 1;
      queue.push(pairs[cut].bodies[i]);
      while (!queue.empty()) {
        const std::size_t here = queue.front();
        queue.pop();
        for (std::size_t p = 0; p < pairs.size(); ++p) {
          if (p == cut || !has(pairs[p].bodies, here)) continue;
          for (const std::size_t next : pairs[p].bodies) {
            if (steps[next] != 0) continue;
            steps[next] = steps[here] + 1;
            queue.push(next);
          }
        }
      }
      largest = std::max(largest, steps[pairs[cut].bodies[0]]);
    }
  }
  return largest;
}

}  // namespace oblique::mechanism
