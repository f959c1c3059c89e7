// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Where may the next module go: candidates a second, beside a check of each.
//   next_bench [FAMILY SIZE [LOAD]]...
// LOAD: strengths are such that this is the largest load ratio before the next module; 0 leaves
// them. Without arguments: the families of docs/next.md. Checks are made of every so many
// candidates, and what differs from them is counted.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
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

void run(const Case& what) {
  const model::RobotSpec spec = make(what);
  const std::vector<base::Cell> cells = plan::free_cells(spec);
  const plan::CandidateReport fast = plan::judge_candidates(spec, cells);
  const std::size_t stride = std::max<std::size_t>(1, cells.size() / kCheckedMax);
  std::vector<base::Cell> some;
  for (std::size_t i = 0; i < cells.size(); i += stride) {
    some.push_back(cells[i]);
  }
  const plan::CandidateReport full = plan::judge_candidates(spec, some, {.is_by_checks = true});
  std::size_t different_count = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    different_count += is_same(fast.candidates[i * stride], full.candidates[i]) ? 0 : 1;
  }
  std::size_t counts[4] = {};
  for (const plan::Candidate& candidate : fast.candidates) {
    counts[static_cast<std::size_t>(candidate.judgement.verdict)] += candidate.is_robot ? 1 : 0;
  }
  const double judging = fast.seconds - fast.preparation_seconds;
  fmt::print(
      "{:8} {:5} load {:4.2f} {:6} modules {:6} candidates: {:7.1f} ms before, {:8.1f} ms for "
      "them, "
      "{:8.0f} /s, {:8.0f} /s in all; {:4} checks; safe {} overload {} unstable {} undecided {}; "
      "by checks {:6.0f} /s, {} of {} differ\n",
      what.family, what.size, what.load, spec.existing.size(), cells.size(),
      1e3 * fast.preparation_seconds, 1e3 * judging, static_cast<double>(cells.size()) / judging,
      static_cast<double>(cells.size()) / fast.seconds, fast.check_count, counts[0], counts[1],
      counts[2], counts[3], static_cast<double>(some.size()) / full.seconds, different_count,
      some.size());
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
