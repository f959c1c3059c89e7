// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <utility>

#include "failures/losses_words.hpp"
#include "failures/sure.hpp"
#include "holdfast/base/check.hpp"

namespace holdfast {
namespace {

using verdict::Verdict;

void take_probability(const std::optional<verdict::Reliability>& sure, double asked, Trial& trial) {
  trial.failures.has_probability = true;
  if (sure) {
    trial.failures.probability_holds = sure->holds;
  }
  const Verdict is_met = verdict::judge_probability(sure, asked);
  if (is_met != Verdict::kSafe) {
    trial.failures.is_improbable = true;
    trial.verdict = is_met;
  }
}

void take_losses(const plan::LossReport& report, Trial& trial) {
  if (!report.fatal.empty()) {
    trial.failures.fatal_loss = loss_words(report.fatal.front().loss);
    trial.verdict = report.fatal.front().verdict;
  } else if (!report.holds_all()) {
    trial.failures.is_loss_undecided = true;
    trial.verdict = Verdict::kUndecided;
  }
}

/// Looks at one place after the other.
class NextWalk {
 public:
  NextWalk(const Structure& structure, const PlanFailuresWish& wish)
      : document_(structure.document), wish_(wish) {
    auto spec = io::make_spec(structure.document);
    HOLDFAST_CHECK(spec.has_value());  // The structure's robot was made of it.
    spec_ = std::move(spec).value();
  }

  std::optional<base::Error> look_at(Trial& trial) {
    model::RobotSpec grown = spec_;
    add_module(grown, trial.cell, Role::kPlanned);
    if (wish_.is_scatter_wanted) {
      const auto sure = find_sure(grown, document_, wish_);
      if (!sure) {
        return sure.error();
      }
      take_probability(sure.value().reliability, wish_.probability, trial);
    }
    if (wish_.is_lose_one_wanted && trial.verdict == Verdict::kSafe) {
      plan::LossOptions options = loss_options(wish_.lose_one);
      options.progress = {};
      take_losses(plan::lose_each(grown, options), trial);
    }
    return std::nullopt;
  }

 private:
  const io::Document& document_;
  const PlanFailuresWish& wish_;
  model::RobotSpec spec_;
};

/// Puts safe places first, as plan::sort_candidates() does; those of one verdict stay in order.
void sort_by_verdict(std::vector<Trial>& trials) {
  std::ranges::stable_sort(trials, {},
                           [](const Trial& trial) { return verdict::severity(trial.verdict); });
}

}  // namespace

std::optional<base::Error> find_next_failures(const Structure& structure,
                                              const PlanFailuresWish& wish,
                                              const NextFailuresLimits& limits,
                                              NextResult& result) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const auto safe_end = std::ranges::find_if(
      result.candidates, [](const Trial& trial) { return trial.verdict != Verdict::kSafe; });
  NextWalk walk(structure, wish);
  std::size_t safe_count = 0;
  std::size_t done = 0;
  auto next = result.candidates.begin();
  for (; next != safe_end; ++next) {
    const bool is_enough = limits.safe_count_max > 0 && safe_count == limits.safe_count_max;
    if (is_enough || seconds() >= limits.seconds_max ||
        (limits.is_interrupted && limits.is_interrupted())) {
      break;
    }
    if (auto error = walk.look_at(*next)) {
      return error;
    }
    safe_count += next->verdict == Verdict::kSafe ? 1 : 0;
    if (wish.progress) {
      wish.progress(++done);
    }
  }
  result.open_count += static_cast<std::size_t>(safe_end - next);
  result.candidates.erase(next, safe_end);
  sort_by_verdict(result.candidates);
  result.seconds += seconds();
  return std::nullopt;
}

}  // namespace holdfast
