// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace meridian::test {

/// What a search over all interleavings found.
struct Exploration {
  std::size_t states = 0;
  std::size_t steps = 0;
  std::string complaint;           ///< of the first state that is wrong, the shortest way to it
  std::vector<std::string> trail;  ///< the steps from the first state to it
  bool is_complete = false;        ///< every reachable state was seen

  [[nodiscard]] std::string text() const {
    std::string all = complaint;
    for (const std::string& step : trail) all += "\n  " + step;
    return all;
  }
};

/// Where one step leads, and what it is called.
template <class State>
struct Step {
  std::string name;
  State state;
};

/// Goes breadth first through every state that `steps_of` leads to from `first`, states of the same
/// `key_of` being one, until `complaint_of` finds one wrong (a text that is not empty), all were
/// seen, or there are more than `max`.
template <class State>
[[nodiscard]] Exploration explore(
    const State& first, const std::function<std::vector<Step<State>>(const State&)>& steps_of,
    const std::function<std::string(const State&)>& key_of,
    const std::function<std::string(const State&)>& complaint_of, std::size_t max) {
  struct Node {
    std::size_t parent;
    std::string step;
  };
  Exploration found;
  std::vector<Node> nodes{{0, ""}};
  std::map<std::string, std::size_t> seen{{key_of(first), 0}};
  std::deque<std::pair<std::size_t, State>> waiting;
  waiting.emplace_back(0, first);
  const auto is_wrong = [&](std::size_t at, const State& state) {
    found.complaint = complaint_of(state);
    if (found.complaint.empty()) return false;
    for (; at != 0; at = nodes[at].parent) {
      found.trail.insert(found.trail.begin(), nodes[at].step);
    }
    return true;
  };
  found.states = 1;
  if (is_wrong(0, first)) return found;
  while (!waiting.empty()) {
    const std::size_t from = waiting.front().first;
    std::vector<Step<State>> steps = steps_of(waiting.front().second);
    waiting.pop_front();
    for (Step<State>& step : steps) {
      ++found.steps;
      if (!seen.emplace(key_of(step.state), nodes.size()).second) continue;
      nodes.push_back({from, std::move(step.name)});
      found.states = nodes.size();
      if (is_wrong(nodes.size() - 1, step.state)) return found;
      waiting.emplace_back(nodes.size() - 1, std::move(step.state));
      if (nodes.size() > max) return found;
    }
  }
  found.is_complete = true;
  return found;
}

}  // namespace meridian::test
