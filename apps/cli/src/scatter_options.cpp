// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "scatter_options.hpp"

namespace holdfast::cli {
namespace {

/// The share that a text such as "10%" means; none if it is no percentage that may be.
std::optional<double> share_of(std::string text, double max = verdict::kCvMax) {
  if (text.empty() || text.back() != '%') {
    return std::nullopt;
  }
  text.pop_back();
  double number = 0;
  const bool is_read = CLI::detail::lexical_cast(text, number);
  const double share = number / 100;
  const bool is_allowed = share >= verdict::kCvMin && share <= max;
  return is_read && is_allowed ? std::optional(share) : std::nullopt;
}

/// Says what is wrong with a percentage up to `max`.
std::function<std::string(const std::string&)> share_fault(double max = verdict::kCvMax) {
  return [max](const std::string& text) {
    return share_of(text, max) ? std::string()
                               : fmt::format(
                                     "expected a percentage from {:g}% to {:g}%, such as 10%; "
                                     "found '{}'",
                                     100 * verdict::kCvMin, 100 * max, io::one_line(text));
  };
}

}  // namespace

void add_scatter_options(CLI::App& command, ScatterOptions& options) {
  command
      .add_option("--scatter", options.cv,
                  "Find the probability that every connection holds if strengths scatter by this "
                  "standard deviation, each by itself; without it as the file states it")
      ->type_name("PERCENT")
      ->check(share_fault());
  command
      .add_option("--scatter-common", options.common,
                  "And by this one all together, as those of one batch do")
      ->type_name("PERCENT")
      ->check(share_fault());
  command
      .add_option("--scatter-mass", options.mass,
                  "And the masses of modules by this one, each by itself; without it as the file "
                  "states it")
      ->type_name("PERCENT")
      ->check(share_fault(verdict::kMassCvMax));
  command
      .add_option("--scatter-law", options.distribution,
                  "The distribution of strengths; without it as the file states it, or lognormal")
      ->type_name("lognormal|normal|weibull")
      ->check([](const std::string& text) {
        return verdict::find_strength_distribution(text)
                   ? std::string()
                   : fmt::format("expected lognormal, normal or weibull; found '{}'",
                                 io::one_line(text));
      });
  command
      .add_option("--probability", options.probability,
                  "The exit status is 1 if the connections hold with less than this probability")
      ->check(number_between(0.0, 1.0));
}

ScatterWish read_scatter(const ScatterOptions& options) {
  return {.strength_cv = share_of(options.cv),
          .common_cv = share_of(options.common).value_or(0),
          .distribution = verdict::find_strength_distribution(options.distribution),
          .mass_cv = share_of(options.mass, verdict::kMassCvMax)};
}

base::Error nothing_scatters() {
  return base::bad_input(
      "nothing is known to scatter, expected --scatter, --scatter-common, --scatter-mass, or "
      "strength_cv or mass_cv in the file");
}

int exit_code_of(const ScatterOptions& options,
                 const std::optional<verdict::Reliability>& reliability) {
  return exit_code(verdict::judge_probability(reliability, options.probability));
}

}  // namespace holdfast::cli
