// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Does the answer depend on how a robot lies and how large it is?
//   symmetry_bench FROM TO      standing_robot(FROM) to standing_robot(TO - 1)
// Every robot that stands is assessed in all eight ways it can be turned and mirrored, its modules
// in another order each time, once as it is meant to be and once by multigrid, against the direct
// solver. Prints each robot whose answers differ and how many there are.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include "holdfast/verdict/assessment.hpp"
#include "standing_robot.hpp"

namespace {

using namespace holdfast;
using solver::Method;

/// Load ratios farther apart than this share of the largest one, or of 1, are another answer;
/// multigrid promises 1e-4 for each of two.
constexpr double kSameShare = 1e-3;

/// The answer for a robot, in its own frame.
struct Answer {
  verdict::Assessment assessment;
  std::map<std::pair<base::Cell, base::Cell>, double> load_ratio;
  std::map<base::Cell, int> corner_count;  ///< Of every foot: how many corners press.
};

int corner_count(const mechanics::ContactState& state) {
  const int tilt_count = (state.tilt_x != 0 ? 1 : 0) + (state.tilt_y != 0 ? 1 : 0);
  return state.pressed ? 4 >> tilt_count : 0;
}

/// The turn that takes `turn` back.
int inverse(int turn) {
  const int half = test::kTurnCount / 2;
  return turn < half ? (half - turn) % half : turn;
}

Answer answer(const model::RobotSpec& spec, int turn, Method method) {
  const auto robot =
      model::Robot::create(test::turned(spec, turn, static_cast<std::uint64_t>(turn)));
  HOLDFAST_CHECK(robot.has_value());
  Answer answer;
  answer.assessment = verdict::assess(robot.value(), {.method = method});
  const auto original = [&](const base::Cell& cell) { return test::turned(cell, inverse(turn)); };
  for (std::size_t i = 0; i < answer.assessment.connections.size(); ++i) {
    const auto [a, b] = model::ends(robot.value(), i);
    answer.load_ratio[std::minmax(original(a), original(b))] =
        answer.assessment.connections[i].load_ratio;
  }
  for (std::size_t i = 0; i < answer.assessment.equilibrium.contact.size(); ++i) {
    answer.corner_count[original(
        robot.value().modules()[base::at(robot.value().facets()[i].module)].cell)] =
        corner_count(answer.assessment.equilibrium.contact[i]);
  }
  return answer;
}

/// Says what differs; empty if nothing does.
std::string difference(const Answer& a, const Answer& b) {
  if (a.assessment.verdict != b.assessment.verdict) {
    return fmt::format("{} or {}", name(a.assessment.verdict), name(b.assessment.verdict));
  }
  if (a.assessment.contact_model != b.assessment.contact_model) {
    return fmt::format("{} or {} contact", name(a.assessment.contact_model),
                       name(b.assessment.contact_model));
  }
  double largest = 1;
  double change = 0;
  for (const auto& [ends, ratio] : a.load_ratio) {
    largest = std::max(largest, ratio);
    change = std::max(change, std::abs(ratio - b.load_ratio.at(ends)));
  }
  if (!(change <= kSameShare * largest)) {
    return fmt::format("a load ratio differs by {:.5f}, the largest is {:.5f}", change, largest);
  }
  return a.corner_count != b.corner_count ? "feet press in another way" : "";
}

struct Counts {
  int stable = 0;
  int different = 0;
  int other_loads = 0;  ///< Of these, those with other loads, law or verdict.
  int undecided = 0;
  int unilateral = 0;
};

void look_at(std::uint64_t seed, Counts& counts) {
  const model::RobotSpec spec = test::standing_robot(seed);
  const Answer reference = answer(spec, 0, Method::kDirect);
  if (!reference.assessment.is_stable) {
    return;
  }
  const verdict::Assessment& assessment = reference.assessment;
  ++counts.stable;
  counts.undecided += assessment.verdict == verdict::Verdict::kUndecided ? 1 : 0;
  counts.unilateral += assessment.contact_model == verdict::ContactModel::kUnilateral ? 1 : 0;
  std::string differences;
  bool has_other_loads = false;
  for (int turn = 0; turn < test::kTurnCount; ++turn) {
    for (const Method method : {Method::kDirect, Method::kAutomatic, Method::kMultigrid}) {
      const std::string text = difference(reference, answer(spec, turn, method));
      if (!text.empty()) {
        has_other_loads = has_other_loads || text.find("another way") == std::string::npos;
        constexpr const char* kNames[] = {"automatic", "direct", "multigrid"};
        differences +=
            fmt::format("  turn {}, {}: {}\n", turn, kNames[static_cast<int>(method)], text);
      }
    }
  }
  if (!differences.empty()) {
    ++counts.different;
    counts.other_loads += has_other_loads ? 1 : 0;
    fmt::print("standing_robot({}), {} modules:\n{}", seed, spec.existing.size(), differences);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: symmetry_bench FROM TO\n");
    return 64;
  }
  Counts counts;
  const std::uint64_t to = std::strtoull(argv[2], nullptr, 10);
  for (std::uint64_t seed = std::strtoull(argv[1], nullptr, 10); seed < to; ++seed) {
    look_at(seed, counts);
  }
  fmt::print(
      "{} robots stand, each in {} ways by three methods: {} with answers that differ, {} of them "
      "in loads, law or verdict; {} undecided, {} by the exact law\n",
      counts.stable, test::kTurnCount, counts.different, counts.other_loads, counts.undecided,
      counts.unilateral);
  return counts.other_loads == 0 ? 0 : 1;
}
