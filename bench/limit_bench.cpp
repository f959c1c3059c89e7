// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// How right are verdicts and ranges? Random robots against another solver in 106 bits.
//   limit_bench errors FROM TO MIN MAX   seeds, module counts: errors of every load ratio, ranges
//   limit_bench limit FROM TO MIN MAX    strengths scaled so that the largest load ratio is 1 + d
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "exact_loads.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "random_robot.hpp"

namespace holdfast::bench {
namespace {

using verdict::Assessment;
using verdict::ContactModel;
using verdict::Verdict;

struct Tally {
  int tried = 0;     ///< Stable robots.
  int compared = 0;  ///< With the paper's contact law and its answer from both.
  int exact_law = 0;
  int other_answer = 0;  ///< Contact states differ.
  int wrong = 0;
  int undecided = 0;
  int several = 0;             ///< Of these, as several solutions of the law do not agree.
  int missed = 0;              ///< The range does not hold the truth.
  int beyond_1e4 = 0;          ///< Some load ratio is off by more than 1e-4 of the largest or of 1.
  double error = 0;            ///< The largest of these.
  double error_by_change = 0;  ///< Of errors over 1e-6, by what the last iterations changed.
};

/// The largest load ratio is what it is with other strengths when these are scaled.
model::RobotSpec scaled(model::RobotSpec spec, double factor) {
  spec.material.strength_vertical_n *= factor;
  spec.material.strength_lateral_n *= factor;
  return spec;
}

long double largest(const std::vector<long double>& ratios) {
  return *std::max_element(ratios.begin(), ratios.end());
}

void compare(const Assessment& found, const std::vector<long double>& exact, std::uint64_t seed,
             Tally& tally) {
  const long double top = largest(exact);
  const double scale = std::max(1.0, static_cast<double>(top));
  double error = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    error = std::max(
        error, static_cast<double>(std::abs(found.connections[i].load_ratio - exact[i])) / scale);
  }
  const bool is_missed = top < found.load_ratio_range.low || top > found.load_ratio_range.high;
  const bool is_broken = top >= 1;
  const bool is_wrong = found.verdict == (is_broken ? Verdict::kSafe : Verdict::kOverload);
  ++tally.compared;
  tally.missed += is_missed ? 1 : 0;
  tally.beyond_1e4 += error > 1e-4 ? 1 : 0;
  tally.error = std::max(tally.error, error);
  if (error > 1e-6) {
    tally.error_by_change =
        std::max(tally.error_by_change, error * scale / found.load_ratio_change);
  }
  tally.wrong += is_wrong ? 1 : 0;
  const bool is_undecided = found.verdict == Verdict::kUndecided;
  tally.undecided += is_undecided ? 1 : 0;
  tally.several += is_undecided && found.several ? 1 : 0;
  if (is_missed || is_wrong || error > 1e-4 || (is_undecided && !found.several)) {
    std::printf("seed %llu: exact %.12Lf range [%.12f, %.12f] error %.1e %s%s\n",
                static_cast<unsigned long long>(seed), top, found.load_ratio_range.low,
                found.load_ratio_range.high, error, verdict::name(found.verdict),
                is_wrong    ? " WRONG"
                : is_missed ? " MISSED"
                            : "");
  }
}

void run(bool is_near, std::uint64_t seed, std::size_t low, std::size_t high, Tally& tally) {
  model::RobotSpec spec = test::random_robot(seed, low, high);
  auto robot = model::Robot::create(spec);
  if (!robot || !verdict::assess_rigid_body(robot.value()).is_stable) {
    return;
  }
  ++tally.tried;
  const auto exact = test::ExactLoads(robot.value()).load_ratios();
  if (!exact) {
    ++tally.exact_law;
    return;
  }
  constexpr double kDistances[] = {5e-5, -5e-5, 1e-5, -1e-5, 1e-6, -1e-6,
                                   1e-7, -1e-7, 1e-8, -1e-8, 3e-9, -3e-9};
  std::vector<long double> expected = *exact;
  const long double top = largest(expected);
  if (is_near) {
    if (top < 1e-3) {
      return;  // Nothing that scaling could break.
    }
    const double distance = kDistances[seed / 12 % 12];
    const double factor = static_cast<double>(top / (1 + distance));
    spec = scaled(spec, factor);
    for (long double& ratio : expected) {
      ratio /= factor;
    }
    robot = model::Robot::create(spec);
  }
  const Assessment found = verdict::assess(robot.value());
  if (found.contact_model == ContactModel::kUnilateral || found.connections.empty()) {
    ++tally.other_answer;
    return;
  }
  compare(found, expected, seed, tally);
}

}  // namespace
}  // namespace holdfast::bench

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "limit_bench: see the first lines of bench/limit_bench.cpp\n");
    return 64;
  }
  const bool is_near = std::strcmp(argv[1], "limit") == 0;
  holdfast::bench::Tally tally;
  for (std::uint64_t seed = std::strtoull(argv[2], nullptr, 10);
       seed < std::strtoull(argv[3], nullptr, 10); ++seed) {
    holdfast::bench::run(is_near, seed, std::strtoull(argv[4], nullptr, 10),
                         std::strtoull(argv[5], nullptr, 10), tally);
  }
  std::printf(
      "stable %d, compared %d, wrong %d, undecided %d (%d by several solutions), range missed %d, "
      "beyond 1e-4 %d, "
      "largest error %.1e, at most %.2f of the last change; without an answer by the paper's law "
      "%d, answered by the exact "
      "law %d\n",
      tally.tried, tally.compared, tally.wrong, tally.undecided, tally.several, tally.missed,
      tally.beyond_1e4, tally.error, tally.error_by_change, tally.exact_law, tally.other_answer);
  return tally.wrong == 0 ? 0 : 1;
}
