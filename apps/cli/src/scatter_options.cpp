// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "scatter_options.hpp"

namespace holdfast::cli {
namespace {

/// The share that a text such as "10%" means; none if it is no percentage from `min` to `max`.
std::optional<double> share_of(std::string text) {
  if (text.empty() || text.back() != '%') {
    return std::nullopt;
  }
  text.pop_back();
  double number = 0;
  const bool is_read = CLI::detail::lexical_cast(text, number);
  const double share = number / 100;
  const bool is_allowed = share >= verdict::kCvMin && share <= verdict::kCvMax;
  return is_read && is_allowed ? std::optional(share) : std::nullopt;
}

std::string share_fault(const std::string& text) {
  return share_of(text) ? std::string()
                        : fmt::format(
                              "expected a percentage from {:g}% to {:g}%, such as 10%; "
                              "found '{}'",
                              100 * verdict::kCvMin, 100 * verdict::kCvMax, io::one_line(text));
}

}  // namespace

void add_scatter_options(CLI::App& command, ScatterOptions& options) {
  CLI::Option* const scatter =
      command
          .add_option("--scatter", options.cv,
                      "Find the probability that every connection holds if strengths scatter by "
                      "this standard deviation, each by itself")
          ->type_name("PERCENT")
          ->check(share_fault);
  command
      .add_option("--scatter-common", options.common,
                  "And by this one all together, as those of one batch do")
      ->type_name("PERCENT")
      ->needs(scatter)
      ->check(share_fault);
  command.add_option("--scatter-law", options.distribution, "The distribution of strengths")
      ->type_name("lognormal|normal|weibull")
      ->needs(scatter)
      ->check([](const std::string& text) {
        return verdict::find_strength_distribution(text)
                   ? std::string()
                   : fmt::format("expected lognormal, normal or weibull; found '{}'",
                                 io::one_line(text));
      })
      ->capture_default_str();
  command
      .add_option("--probability", options.probability,
                  "The exit status is 1 if the connections hold with less than this probability")
      ->needs(scatter)
      ->check(number_between(0.0, 1.0));
}

verdict::StrengthScatter read_scatter(const ScatterOptions& options) {
  return {.distribution = verdict::find_strength_distribution(options.distribution)
                              .value_or(verdict::StrengthDistribution::kLognormal),
          .cv = share_of(options.cv).value_or(0),
          .common_cv = share_of(options.common).value_or(0)};
}

int exit_code_of(const ScatterOptions& options,
                 const std::optional<verdict::Reliability>& reliability) {
  if (options.probability <= 0) {
    return kExitSafe;
  }
  if (!reliability) {
    return kExitUndecided;
  }
  if (reliability->holds_high < options.probability) {
    return kExitUnsafe;
  }
  return reliability->holds_low < options.probability ? kExitUndecided : kExitSafe;
}

}  // namespace holdfast::cli
