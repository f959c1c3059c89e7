// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "check_options.hpp"
#include "common.hpp"
#include "holdfast/cascade.hpp"
#include "holdfast/fit.hpp"
#include "long_work.hpp"
#include "plan_failures_wish.hpp"

/// Adds how sure a report is, what follows from losses and what follows the break: as the members
/// of a JSON report.
namespace holdfast::python {
namespace {

/// The object that `write(json)` makes of one member.
template <class Write>
std::string object_of(const Write& write) {
  std::string text;
  io::JsonStream json(text);
  json.begin_object();
  write(json);
  json.end_object();
  return text;
}

constexpr double kAnyShare = std::numeric_limits<double>::max();

/// A share as Python says it; none for None.
std::optional<double> share_of(const py::object& given, const char* what,
                               double most = verdict::kCvMax) {
  if (given.is_none()) {
    return std::nullopt;
  }
  const double share = number_of(given, what, -kAnyShare, kAnyShare);
  if (!(share >= verdict::kCvMin && share <= most)) {
    throw Error(std::string(what) + ": expected a share from 0.0001 to " +
                (most < verdict::kCvMax ? "0.3" : "1") + ", found " + std::to_string(share));
  }
  return share;
}

ScatterWish scatter_wish(const py::object& scatter, const py::object& common, const py::object& law,
                         const py::object& mass) {
  const bool is_common =
      !common.is_none() && number_of(common, "common", -kAnyShare, kAnyShare) != 0;
  ScatterWish wish{.strength_cv = share_of(scatter, "scatter"),
                   .common_cv = is_common ? *share_of(common, "common") : 0,
                   .mass_cv = share_of(mass, "mass", verdict::kMassCvMax)};
  if (!law.is_none()) {
    const std::string name = utf8_of(law, "law");
    wish.distribution = verdict::find_strength_distribution(name);
    if (!wish.distribution) {
      throw Error("law: expected lognormal, normal or weibull, found '" + io::one_line(name) + "'");
    }
  }
  return wish;
}

/// The kinds of parts that are lost, from their names.
std::array<bool, plan::kLossKindCount> kinds_of(const py::iterable& parts) {
  std::array<bool, plan::kLossKindCount> kinds = {};
  for (const py::handle& given : parts) {
    const std::string part = utf8_of(given, "parts");
    bool is_known = false;
    for (std::size_t i = 0; i < plan::kLossKindCount; ++i) {
      if (part == plan::name(static_cast<plan::LossKind>(i))) {
        kinds[i] = is_known = true;
      }
    }
    if (!is_known) {
      throw Error("parts: expected 'connection', 'module' or 'foot', found '" + io::one_line(part) +
                  "'");
    }
  }
  return kinds;
}

std::string reliability(const SharedCheck& check, const py::object& scatter,
                        const py::object& common, const py::object& law, const py::object& mass) {
  const ScatterWish wish = scatter_wish(scatter, common, law, mass);
  const Structure& structure = *check->structure;
  expect_one_piece(structure, "reliability()");
  const auto how = find_scatter(structure, wish);
  if (!how) {
    throw Error(
        "nothing is known to scatter, expected scatter, common or mass, or strength_cv or "
        "mass_cv of the robot");
  }
  return object_of([&](io::JsonStream& json) {
    write_reliability_member(json, structure.robot, *how,
                             find_reliability(structure, check->result, *how));
  });
}

std::string lose_one(const SharedStructure& structure, const py::iterable& parts, double seconds,
                     const py::handle& threads, const py::handle& memory, bool is_bonded,
                     bool is_cascade_wanted, bool is_deformed_wanted, py::object progress) {
  expect_one_piece(*structure, "lose_one()");
  LoseOneOptions options;
  options.check = check_options(threads, memory, is_bonded);
  options.check.is_deformed_wanted = is_deformed_wanted;
  options.is_cascade_wanted = is_cascade_wanted;
  options.seconds_max = seconds;
  options.kinds = kinds_of(parts);
  Watch watch(std::move(progress));
  options.progress = [&](std::size_t done, std::size_t count) { watch(done, count); };
  const plan::LossReport report =
      without_gil(watch, [&] { return holdfast::lose_one(*structure, options); });
  return object_of(
      [&](io::JsonStream& json) { write_lose_one_member(json, structure->robot, report); });
}

/// Fits experiments in a text; structures are files in the folder.
std::string fit(const std::string& text, const std::string& folder) {
  const FitReport report = take(without_gil([&] { return fit_text(text, folder); }));
  return fit_json(report);
}

std::string cascade(const SharedStructure& structure, const py::handle& threads,
                    const py::handle& memory, bool is_bonded, bool is_deformed_wanted,
                    py::object progress) {
  expect_one_piece(*structure, "cascade()");
  CheckOptions options = check_options(threads, memory, is_bonded);
  options.is_deformed_wanted = is_deformed_wanted;
  Watch watch(std::move(progress));
  const plan::Cascade found = without_gil(watch, [&] {
    return find_cascade(*structure, options,
                        [&](std::size_t standing, std::size_t count) { watch(standing, count); });
  });
  return object_of([&](io::JsonStream& json) { write_cascade_member(json, found); });
}

}  // namespace

PlanFailuresWish plan_failures_wish(const py::dict& asked, const CheckOptions& check) {
  const auto given = [&](const char* key) -> py::object {
    return asked.contains(key) ? py::object(asked[key]) : py::none();
  };
  PlanFailuresWish wish{
      .is_scatter_wanted = asked.contains("scatter") || asked.contains("common") ||
                           asked.contains("law") || asked.contains("mass") ||
                           asked.contains("probability"),
      .scatter = scatter_wish(given("scatter"), given("common"), given("law"), given("mass")),
      .lose_one = {.check = check}};
  if (asked.contains("probability")) {
    wish.probability = number_of(asked["probability"], "probability", 0, 1);
  }
  wish.is_lose_one_wanted = asked.contains("lose_one") && asked["lose_one"].cast<bool>();
  if (asked.contains("parts")) {
    wish.lose_one.kinds = kinds_of(asked["parts"]);
  }
  if (asked.contains("lose_seconds")) {
    wish.lose_one.seconds_max = number_of(asked["lose_seconds"], "lose_seconds", 0,
                                          std::numeric_limits<double>::infinity());
  }
  if (!wish.is_lose_one_wanted && (asked.contains("parts") || asked.contains("lose_seconds"))) {
    throw Error("parts and lose_seconds are of lose_one, expected lose_one=True");
  }
  return wish;
}

void add_failures(py::module_& module) {
  module.def("reliability", &reliability);
  module.def("lose_one", &lose_one);
  module.def("fit", &fit);
  module.def("cascade", &cascade);
}

}  // namespace holdfast::python
