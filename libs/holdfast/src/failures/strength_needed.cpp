// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "holdfast/order.hpp"

namespace holdfast {
namespace {

using plan::OrderOutcome;

/// No larger or smaller factor is tried: a robot without order then topples, or carries nothing.
constexpr double kFactorMax = 1e6;
constexpr double kFactorMin = 1e-6;

/// What a load ratio found may be off, so that an order is safe with the factor that it asks for:
/// that of a verdict, and rounding.
constexpr double kRatioError = 1e-6;

/// Searches with one factor after the other.
class Bottleneck {
 public:
  Bottleneck(const io::Document& target, OrderRequest request)
      : target_(target), request_(std::move(request)), begin_(std::chrono::steady_clock::now()) {
    request_.is_exact = true;  // The largest load ratio of the way is needed, not a bound.
    request_.help_seconds_max = 0;
  }

  base::Result<StrengthNeeded> find() && {
    if (request_.parallel_max > 1) {
      return base::bad_input("which strength is needed is found for modules one after another");
    }
    double factor = 1;
    while (is_open()) {
      auto report = with(factor);
      // With so weak strengths the single module that is to begin with may not be safe.
      if (!report && needed_.search_count > 1 && report.error().where == plan::kAtStart) {
        needed_.none = std::max(needed_.none, factor);
      } else if (!report) {
        return report.error();
      } else if (!take(factor, std::move(report).value())) {
        break;
      }
      factor = next();
    }
    needed_.is_certain = is_ended();
    return std::move(needed_);
  }

 private:
  bool is_ended() const {
    return needed_.enough && *needed_.enough <= needed_.none * (1 + kNeededDigits) + kFactorMin;
  }

  bool is_open() const { return !is_ended() && needed_.none < kFactorMax && seconds_left() > 0; }

  double seconds_left() const {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin_;
    return request_.seconds_max - passed.count();
  }

  base::Result<io::OrderReport> with(double factor) {
    ++needed_.search_count;
    io::Document document = target_;
    document.extension.safety_factor = target_.extension.safety_factor / factor;
    OrderRequest request = request_;
    request.seconds_max = seconds_left();
    return seek_order(document, request);
  }

  /// Returns whether the search told something.
  bool take(double factor, io::OrderReport report) {
    const OrderOutcome outcome = report.result.order.outcome;
    report.target.extension.safety_factor = target_.extension.safety_factor;
    if (outcome == OrderOutcome::kFound) {
      const double ratio = report.result.load_ratio_max.value_or(0);
      needed_.enough =
          std::min(factor, factor * std::max(0.0, ratio) * (1 + kRatioError) + kFactorMin);
      for (auto* const number : {&report.result.load_ratio_max, &report.result.load_ratio_bound}) {
        *number = *number ? std::optional(**number * factor) : std::nullopt;
      }
    } else if (outcome == OrderOutcome::kNone) {
      needed_.none = factor;
    }
    if (outcome == OrderOutcome::kFound || !needed_.enough) {
      needed_.report = std::move(report);
    }
    return outcome != OrderOutcome::kNotFound;
  }

  /// The first factor below what is enough tells mostly whether that is the bottleneck; where it is
  /// not, the middle is next, so that there is no end of small steps.
  double next() {
    if (!needed_.enough) {
      return needed_.none * 4;
    }
    const double below = *needed_.enough / (1 + kNeededDigits / 2);
    is_below_next_ = !is_below_next_;
    return is_below_next_ ? below : std::sqrt(std::max(needed_.none, kFactorMin) * *needed_.enough);
  }

  const io::Document& target_;
  OrderRequest request_;
  std::chrono::steady_clock::time_point begin_;
  StrengthNeeded needed_;
  bool is_below_next_ = false;
};

}  // namespace

base::Result<StrengthNeeded> seek_strength_needed(const io::Document& target,
                                                  const OrderRequest& request) {
  return Bottleneck(target, request).find();
}

std::string strength_needed_text(const StrengthNeeded& needed) {
  const auto line = [](const std::string& text) {
    return fmt::format("  {:<12}{}\n", "strength", text);
  };
  if (!needed.enough) {
    return line(needed.none >= kFactorMax
                    ? std::string("no factor of the strengths makes an order possible")
                    : fmt::format("undecided: no order with {:.6g} times the strengths, none found "
                                  "with more",
                                  needed.none));
  }
  if (needed.is_certain) {
    return line(
        fmt::format("an order needs {:.5g} times the strengths; with {:.5g} times there is "
                    "none",
                    *needed.enough, needed.none));
  }
  return line(fmt::format("undecided: an order needs between {:.5g} and {:.5g} times the strengths",
                          needed.none, *needed.enough));
}

std::string strength_needed_member(const StrengthNeeded& needed) {
  std::string text;
  io::JsonStream json(text, io::JsonStream::Layout::kLine);
  json.begin_object();
  json.member("none", needed.none);
  json.member("enough", needed.enough);
  json.member("is_certain", needed.is_certain);
  json.member("searches", needed.search_count);
  json.end_object();
  return "\"strength_needed\": " + text;
}

}  // namespace holdfast
