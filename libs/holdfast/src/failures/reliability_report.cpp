// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "holdfast/reliability.hpp"

namespace holdfast {
namespace {

using verdict::Reliability;

/// Smaller probabilities are said of failing, larger ones of holding.
constexpr double kRarely = 1e-3;

/// Bounds of the probability that are apart by less are not said.
constexpr double kSameProbability = 5e-4;

constexpr const char* kUnknown =
    "not known, as the robot is not known to stay where it is or has no loads";

/// The largest cv of the masses; 0 if none scatters.
double mass_cv(const verdict::StrengthScatter& scatter) {
  return scatter.mass_cv.empty() ? 0 : *std::ranges::max_element(scatter.mass_cv);
}

std::string scatter_text(const verdict::StrengthScatter& scatter) {
  const bool is_uniform = scatter.own_cv.empty();
  std::string text =
      scatter.cv > verdict::kCvMin
          ? fmt::format("strengths {}+-{:.4g} %", is_uniform ? "" : "up to ", 100 * scatter.cv)
          : std::string("strengths as given");
  if (scatter.common_cv > 0) {
    text += fmt::format(" each, +-{:.4g} % together", 100 * scatter.common_cv);
  }
  if (!scatter.own_distribution.empty()) {
    text += ", of several distributions";
  } else if (scatter.distribution != verdict::StrengthDistribution::kLognormal) {
    text += fmt::format(", {}", name(scatter.distribution));
  }
  if (const double masses = mass_cv(scatter); masses > 0) {
    text += fmt::format(", masses {}+-{:.4g} %",
                        std::ranges::count(scatter.mass_cv, masses) ==
                                static_cast<std::ptrdiff_t>(scatter.mass_cv.size())
                            ? ""
                            : "up to ",
                        100 * masses);
  }
  return text;
}

/// Says of a robot in which no connection fails that none can, or that it was too rare to be seen.
std::string never_text(const Reliability& found) {
  const std::string scatter = scatter_text(found.scatter);
  if (!found.strength_factor_99) {
    return fmt::format("holds whatever the strengths ({}): no connection is pulled", scatter);
  }
  return found.sample_count > 0
             ? fmt::format("holds in all of {} samples of masses ({})", found.sample_count, scatter)
             : fmt::format("fails with a probability below 1e-300 ({})", scatter);
}

std::string probability_text(const Reliability& found) {
  std::string text = found.fails < kRarely
                         ? fmt::format("fails with probability {:.2g}", found.fails)
                         : fmt::format("holds with probability {:.3g}", found.holds);
  text += fmt::format(" ({})", scatter_text(found.scatter));
  if (found.holds_high - found.holds_low > kSameProbability) {
    text += fmt::format(", from {:.3g} to {:.3g} within what {} may be off", found.holds_low,
                        found.holds_high, found.sample_count > 0 ? "samples" : "the loads");
  }
  return text;
}

/// Bounds of a factor that are apart by less are not said, as shares of it.
constexpr double kSameFactor = 5e-3;

/// What a factor that samples have told may be.
std::string factor_range_text(double factor, const verdict::FactorRange& range) {
  if (!range.high) {
    return range.low
               ? fmt::format(" ({:.3g} or more: samples are too few to say how much)", *range.low)
               : std::string(" (samples are too few to bound it)");
  }
  const double low = range.low.value_or(0);
  return *range.high - low > kSameFactor * factor
             ? fmt::format(" ({:.3g} to {:.3g})", low, *range.high)
             : std::string();
}

/// How strong connections would have to be.
std::string factors_text(const Reliability& found) {
  const auto times = [](const std::optional<double>& factor, const verdict::FactorRange& range,
                        const char* what, const char* none) {
    return factor
               ? fmt::format("{:.3g} times{}{}", *factor, what, factor_range_text(*factor, range))
               : std::string(none);
  };
  return fmt::format("for 99 % {}, for 99.9 % {}",
                     times(found.strength_factor_99, found.factor_range_99, " the strengths",
                           "no strengths suffice"),
                     times(found.strength_factor_999, found.factor_range_999, "", "none"));
}

}  // namespace

std::string reliability_text(const model::Robot& robot,
                             const std::optional<Reliability>& reliability) {
  const auto line = [](const char* head, const std::string& text) {
    return fmt::format("  {:<12}{}\n", head, text);
  };
  if (!reliability) {
    return line("reliability", kUnknown);
  }
  const Reliability& found = *reliability;
  std::string text = never_text(found);
  if (!found.likeliest.empty()) {
    const verdict::FailingConnection& first = found.likeliest.front();
    text = fmt::format("{}; {} is the likeliest to fail, in {:.0f} % of the cases",
                       probability_text(found), model::ends_text(robot, first.connection),
                       100 * first.share);
  } else if (!found.strength_factor_99) {
    return line("reliability", text);
  }
  return line("reliability", text) + line("", factors_text(found)) +
         (found.changed_count == 0
              ? std::string()
              : line("", fmt::format("facets are in other states in {} of {} samples of masses",
                                     found.changed_count, found.sample_count)));
}

std::vector<io::MoreNumbers> reliability_numbers(const model::Robot& robot,
                                                 const std::optional<Reliability>& reliability) {
  io::MoreNumbers share{.name = "fail_share"};
  if (reliability) {
    share.connections.assign(robot.connections().size(), 0);
    for (const verdict::FailingConnection& one : reliability->likeliest) {
      share.connections[one.connection] = one.share;
    }
  }
  return {std::move(share)};
}

void write_reliability_member(io::JsonStream& json, const model::Robot& robot,
                              const verdict::StrengthScatter& scatter,
                              const std::optional<Reliability>& reliability) {
  const auto of = [&](double Reliability::*member) {
    return reliability ? std::optional((*reliability).*member) : std::nullopt;
  };
  json.key("reliability");
  json.begin_object();
  json.member("probability_holds", of(&Reliability::holds));
  json.member("probability_fails", of(&Reliability::fails));
  json.member("probability_low", of(&Reliability::holds_low));
  json.member("probability_high", of(&Reliability::holds_high));
  json.member("strength_cv", scatter.cv);
  json.member("common_cv", scatter.common_cv);
  json.member("mass_cv", mass_cv(scatter));
  json.member("distribution", name(scatter.distribution));
  json.key("likeliest");
  json.begin_array();
  const std::size_t named_count =
      reliability ? std::min(reliability->likeliest.size(), verdict::kLikeliestMax) : 0;
  for (std::size_t i = 0; i < named_count; ++i) {
    const verdict::FailingConnection& one = reliability->likeliest[i];
    const auto ends = model::ends(robot, one.connection);
    json.begin_object();
    json.member("a", ends[0]);
    json.member("b", ends[1]);
    json.member("load_ratio", one.load_ratio);
    json.member("share", one.share);
    json.end_object();
  }
  json.end_array();
  json.member("samples", reliability ? reliability->sample_count : 0);
  json.member("samples_with_other_states", reliability ? reliability->changed_count : 0);
  const Reliability& found = reliability ? *reliability : Reliability{};
  json.member("strength_factor_99", found.strength_factor_99);
  json.member("strength_factor_99_low", found.factor_range_99.low);
  json.member("strength_factor_99_high", found.factor_range_99.high);
  json.member("strength_factor_999", found.strength_factor_999);
  json.member("strength_factor_999_low", found.factor_range_999.low);
  json.member("strength_factor_999_high", found.factor_range_999.high);
  json.end_object();
}

}  // namespace holdfast
