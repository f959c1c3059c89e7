// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan_failures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "failures/losses_words.hpp"
#include "failures/sure.hpp"
#include "holdfast/io/steps_report.hpp"
#include "step_walk.hpp"

namespace holdfast {
namespace {

using plan::Stage;
using plan::StageId;
using verdict::StrengthScatter;
using verdict::Verdict;

/// Goes through the stages of a plan.
class PlanWalk {
 public:
  PlanWalk(const io::Document& document, const PlanFailuresWish& wish)
      : document_(document), wish_(wish) {}

  /// The error of a step, if any.
  std::optional<base::Error> add(const plan::RobotState& before, const model::Step& step,
                                 const plan::Transition& transition, std::size_t index) {
    for (std::size_t i = 0; i < plan::kStageCount; ++i) {
      const StageId id{index, static_cast<Stage>(i)};
      const auto scenes = plan::find_scenes(before, step, transition, id.stage);
      if (!scenes) {
        return scenes.error();
      }
      for (const plan::Scene& scene : scenes.value()) {
        if (auto error = add(id, scene)) {
          return error;
        }
      }
    }
    return std::nullopt;
  }

  PlanFailures take() {
    if (found_.first_unknown && !is_known_) {
      found_.probability_min.reset();
      found_.least.reset();
    }
    return found_;
  }

 private:
  std::optional<base::Error> add(const StageId& id, const plan::Scene& scene) {
    Holding holding;
    for (const model::RobotSpec& piece : scene.pieces) {
      ++found_.robot_count;
      if (wish_.is_scatter_wanted) {
        if (auto error = add_scatter(piece, scene.hangings, holding)) {
          return error;
        }
      }
      if (wish_.is_lose_one_wanted && !found_.first_fatal) {
        add_losses(id, piece);
      }
    }
    if (wish_.is_scatter_wanted) {
      note(id, holding);
    }
    return std::nullopt;
  }

  /// The probability that all holds at one moment: the robot or its pieces, and the connections by
  /// which groups hang. They fail by themselves but for G, which all have in common; failures go
  /// together then, and the product is the least that it can be.
  struct Holding {
    double holds = 1;
    double low = 1;
    double high = 1;
    bool is_known = true;

    void add(double one_holds, double one_low, double one_high) {
      holds *= one_holds;
      low *= one_low;
      high = std::min(high, one_high);
    }
  };

  std::optional<base::Error> add_scatter(const model::RobotSpec& piece,
                                         const std::vector<plan::Hanging>& hangings,
                                         Holding& holding) const {
    const auto found = find_sure(piece, document_, wish_);
    if (!found) {
      return found.error();
    }
    const auto& [scatter, sure] = found.value();
    holding.is_known = holding.is_known && sure.has_value();
    if (sure) {
      holding.add(sure->holds, sure->holds_low, sure->holds_high);
    }
    if (!hangings.empty()) {
      std::vector<double> ratios;
      std::ranges::transform(hangings, std::back_inserter(ratios), [&](const plan::Hanging& one) {
        return one.load_ratio / document_.extension.safety_factor;
      });
      const double hold = verdict::find_reliability(ratios, {.distribution = scatter.distribution,
                                                             .cv = scatter.cv,
                                                             .common_cv = scatter.common_cv})
                              .holds;
      holding.add(hold, hold, hold);
    }
    return std::nullopt;
  }

  void note(const StageId& id, const Holding& holding) {
    is_known_ = is_known_ && holding.is_known;
    const auto first = [&](std::optional<StageId>& where) { where = where ? where : id; };
    if (!holding.is_known) {
      first(found_.first_unknown);
      return;
    }
    if (!found_.probability_min || holding.holds < *found_.probability_min) {
      found_.probability_min = holding.holds;
      found_.least = id;
    }
    if (holding.high < wish_.probability) {
      first(found_.first_below);
    } else if (holding.low < wish_.probability) {
      first(found_.first_unknown);
    }
  }

  void add_losses(const StageId& id, const model::RobotSpec& piece) {
    plan::LossOptions options = loss_options(wish_.lose_one);
    options.progress = {};
    const plan::LossReport report = plan::lose_each(piece, options);
    if (!report.fatal.empty()) {
      found_.first_fatal = id;
      found_.fatal = report.fatal.front();
    } else if (!report.holds_all() && !found_.first_undecided) {
      found_.first_undecided = id;
    }
  }

  const io::Document& document_;
  const PlanFailuresWish& wish_;
  PlanFailures found_;
  bool is_known_ = true;
};

std::string words(const StageId& id) {
  return fmt::format("step {}, {}", id.step, plan::name(id.stage));
}

std::string scatter_words(const PlanFailuresWish& wish, const PlanFailures& found) {
  std::string text =
      found.probability_min
          ? fmt::format("every stage holds with probability {:.3g} or more, the least in {}",
                        *found.probability_min, words(*found.least))
          : fmt::format("not known in {}", words(*found.first_unknown));
  if (found.first_below) {
    text += fmt::format("; below {} from {} on", wish.probability, words(*found.first_below));
  } else if (found.first_unknown && wish.probability > 0) {
    text += fmt::format("; {} is not certain in {}", wish.probability, words(*found.first_unknown));
  }
  return text;
}

std::string losing_words(const PlanFailures& found) {
  if (found.first_fatal) {
    return fmt::format("{}: without {} it does not hold", words(*found.first_fatal),
                       loss_words(found.fatal->loss));
  }
  return found.first_undecided
             ? fmt::format("not certain in {}", words(*found.first_undecided))
             : std::string("every stage is safe whatever connection, module or foot is lost");
}

}  // namespace

base::Result<PlanFailures> find_plan_failures(const io::Document& document,
                                              const PlanFailuresWish& wish) {
  const auto sequence = io::make_sequence(document);
  if (!sequence) {
    return sequence.error();
  }
  if (std::ranges::any_of(sequence.value().steps, &model::Step::is_any_order)) {
    return base::bad_input(
        "some steps are done in any order: how sure their parts are, and what may be lost then, is "
        "not known; expected steps whose modules come together or one by one");
  }
  PlanWalk walk(document, wish);
  auto error = for_each_step(sequence.value().start, sequence.value().steps,
                             [&](const plan::RobotState& robot, const model::Step& step,
                                 const plan::Transition& transition, std::size_t i) {
                               auto fault = walk.add(robot, step, transition, i);
                               if (!fault && wish.progress) {
                                 wish.progress(i + 1);
                               }
                               return fault;
                             });
  if (error) {
    return *std::move(error);
  }
  return walk.take();
}

std::string plan_failures_text(const PlanFailuresWish& wish, const PlanFailures& found) {
  std::string text;
  if (wish.is_scatter_wanted && found.robot_count > 0) {
    text += fmt::format("  {:<12}{}\n", "reliability", scatter_words(wish, found));
  }
  if (wish.is_lose_one_wanted && found.robot_count > 0) {
    text += fmt::format("  {:<12}{}\n", "lose one", losing_words(found));
  }
  return text;
}

void write_plan_failures_members(io::JsonStream& json, const PlanFailuresWish& wish,
                                 const PlanFailures& found) {
  if (wish.is_scatter_wanted) {
    json.key("reliability");
    json.begin_object();
    json.member("probability_min", found.probability_min);
    io::write_stage_id(json, "least", found.least);
    io::write_stage_id(json, "first_below", found.first_below);
    io::write_stage_id(json, "first_unknown", found.first_unknown);
    json.end_object();
  }
  if (wish.is_lose_one_wanted) {
    json.key("lose_one");
    json.begin_object();
    json.member("holds_all", !found.first_fatal && !found.first_undecided);
    io::write_stage_id(json, "first_fatal", found.first_fatal);
    json.key("fatal");
    found.fatal ? json.value(std::string_view(loss_words(found.fatal->loss))) : json.value(nullptr);
    io::write_stage_id(json, "first_undecided", found.first_undecided);
    json.end_object();
  }
}

base::Result<PlanFailuresReport> report_plan_failures(const io::Document& document,
                                                      const PlanFailuresWish& wish) {
  PlanFailuresReport report;
  if (!wish.is_wanted()) {
    return report;
  }
  auto found = find_plan_failures(document, wish);
  if (!found) {
    return found.error();
  }
  report.found = std::move(found).value();
  report.text = plan_failures_text(wish, report.found);
  report.members = [wish, found = report.found](io::JsonStream& json) {
    write_plan_failures_members(json, wish, found);
  };
  io::JsonStream json(report.member_text, io::JsonStream::Layout::kLine);
  json.begin_object();
  report.members(json);
  json.end_object();
  report.member_text = report.member_text.substr(1, report.member_text.size() - 2);
  return report;
}

}  // namespace holdfast
