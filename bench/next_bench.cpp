// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Where may the next module go: candidates a second, beside a check of each.
//   next_bench [FAMILY SIZE LOAD]...
// Seconds are those of the processor, on one thread.
// LOAD: strengths are such that this is the largest load ratio before the next module; 0 leaves
// them. Without arguments: the families of docs/planning.md. Checks are made of every so many
// candidates, and what differs from them is counted.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

#include "holdfast/model/families.hpp"
#include "holdfast/plan/candidates.hpp"

namespace {

using namespace holdfast;

struct Case {
  std::string family;
  std::size_t size = 0;
  double load = 0;
};

/// Checks to compare with.
constexpr std::size_t kCheckedMax = 60;

constexpr int kRunCount = 5;

model::RobotSpec make(const Case& what) {
  const auto family = model::find_family(what.family);
  model::RobotSpec spec{.existing = model::family_cells(*family, what.size),
                        .lattice = model::family_lattice(*family)};
  if (what.load > 0) {
    const auto assessment = verdict::assess(model::Robot::create(spec).value());
    const double factor = assessment.load_ratio_max.value_or(1) / what.load;
    spec.material.strength_vertical_n *= factor;
    spec.material.strength_lateral_n *= factor;
  }
  return spec;
}

/// Verdict and load ratio to what checks that iterate are good for.
bool is_same(const plan::Candidate& a, const plan::Candidate& b) {
  const double one = a.judgement.load_ratio_max.value_or(0);
  const double other = b.judgement.load_ratio_max.value_or(0);
  return a.is_robot == b.is_robot && a.judgement.verdict == b.judgement.verdict &&
         std::abs(one - other) <= 1e-4 * std::max(1.0, std::abs(other));
}

/// Seconds of the processor since the program began: others may use the machine as well.
double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

/// All candidates of a robot, twice: the second time nothing has to be prepared.
struct Timed {
  plan::CandidateReport report;
  double first_seconds = std::numeric_limits<double>::infinity();
  double again_seconds = std::numeric_limits<double>::infinity();
};

/// Times all candidates on one thread; the fastest of several runs counts.
Timed time(const model::RobotSpec& spec, const std::vector<base::Cell>& cells) {
  Timed timed;
  for (int i = 0; i < kRunCount; ++i) {
    const double begin = processor_seconds();
    plan::CandidateSearch search(spec, {.equilibrium = {.thread_count = 1}});
    timed.report = search.judge(cells);
    const double middle = processor_seconds();
    search.judge(cells);
    timed.first_seconds = std::min(timed.first_seconds, middle - begin);
    timed.again_seconds = std::min(timed.again_seconds, processor_seconds() - middle);
  }
  return timed;
}

void run(const Case& what) {
  const model::RobotSpec spec = make(what);
  const std::vector<base::Cell> cells = plan::free_cells(spec);
  const Timed timed = time(spec, cells);
  const plan::CandidateReport& fast = timed.report;
  const std::size_t stride = std::max<std::size_t>(1, cells.size() / kCheckedMax);
  std::vector<base::Cell> some;
  for (std::size_t i = 0; i < cells.size(); i += stride) {
    some.push_back(cells[i]);
  }
  const double begin = processor_seconds();
  const plan::CandidateReport full = plan::judge_candidates(
      spec, some, {.equilibrium = {.thread_count = 1}, .is_by_checks = true});
  const double check_seconds = processor_seconds() - begin;
  std::size_t different_count = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    different_count += is_same(fast.candidates[i * stride], full.candidates[i]) ? 0 : 1;
  }
  std::size_t counts[4] = {};
  for (const plan::Candidate& candidate : fast.candidates) {
    counts[static_cast<std::size_t>(candidate.judgement.verdict)] += candidate.is_robot ? 1 : 0;
  }
  const auto count = static_cast<double>(cells.size());
  fmt::print(
      "{:8} {:5} load {:4.2f} {:5} modules {:5} cells: {:6.1f} ms in all {:7.0f} /s, again {:6.1f} "
      "ms {:7.0f} /s, by checks {:5.0f} /s; {} checks; safe {} overload {} "
      "unstable {} undecided {}; {} of {} differ\n",
      what.family, what.size, what.load, spec.existing.size(), cells.size(),
      1e3 * timed.first_seconds, count / timed.first_seconds, 1e3 * timed.again_seconds,
      count / timed.again_seconds, static_cast<double>(some.size()) / check_seconds,
      fast.check_count, counts[0], counts[1], counts[2], counts[3], different_count, some.size());
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Case> cases;
  for (int i = 1; i + 2 < argc; i += 3) {
    cases.push_back({.family = argv[i],
                     .size = std::strtoull(argv[i + 1], nullptr, 10),
                     .load = std::strtod(argv[i + 2], nullptr)});
  }
  if (cases.empty()) {
    cases = {{"cube", 10, 0},      {"tower", 111, 0},    {"growth", 1000, 0},
             {"portal", 34, 0.97}, {"bridge", 15, 0.97}, {"arm", 29, 0.97}};
  }
  for (const Case& each : cases) {
    run(each);
  }
  return 0;
}
