// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>
#include <vector>

#include "check_options.hpp"
#include "common.hpp"
#include "holdfast/cascade.hpp"
#include "holdfast/fit.hpp"
#include "holdfast/losses.hpp"
#include "holdfast/reliability.hpp"
#include "long_work.hpp"

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

/// A share as Python says it; none for None.
std::optional<double> share_of(const py::object& given, const char* what,
                               double most = verdict::kCvMax) {
  if (given.is_none()) {
    return std::nullopt;
  }
  const auto share = given.cast<double>();
  if (!(share >= verdict::kCvMin && share <= most)) {
    throw Error(std::string(what) + ": expected a share from 0.0001 to " +
                (most < verdict::kCvMax ? "0.3" : "1") + ", found " + std::to_string(share));
  }
  return share;
}

std::string reliability(const SharedCheck& check, const py::object& scatter, double common,
                        const py::object& law, const py::object& mass) {
  ScatterWish wish{.strength_cv = share_of(scatter, "scatter"),
                   .common_cv = common == 0 ? 0 : *share_of(py::float_(common), "common"),
                   .mass_cv = share_of(mass, "mass", verdict::kMassCvMax)};
  if (!law.is_none()) {
    const auto name = law.cast<std::string>();
    wish.distribution = verdict::find_strength_distribution(name);
    if (!wish.distribution) {
      throw Error("law: expected lognormal, normal or weibull, found '" + io::one_line(name) + "'");
    }
  }
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

std::string lose_one(const SharedStructure& structure, const std::vector<std::string>& parts,
                     double seconds, const py::handle& threads, const py::handle& memory,
                     bool is_bonded, bool is_cascade_wanted, bool is_deformed_wanted,
                     py::object progress) {
  expect_one_piece(*structure, "lose_one()");
  LoseOneOptions options;
  options.check = check_options(threads, memory, is_bonded);
  options.check.is_deformed_wanted = is_deformed_wanted;
  options.is_cascade_wanted = is_cascade_wanted;
  options.seconds_max = seconds;
  options.kinds = {};
  for (const std::string& part : parts) {
    bool is_known = false;
    for (std::size_t i = 0; i < plan::kLossKindCount; ++i) {
      if (part == plan::name(static_cast<plan::LossKind>(i))) {
        options.kinds[i] = is_known = true;
      }
    }
    if (!is_known) {
      throw Error("parts: expected 'connection', 'module' or 'foot', found '" + io::one_line(part) +
                  "'");
    }
  }
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

void add_failures(py::module_& module) {
  module.def("reliability", &reliability);
  module.def("lose_one", &lose_one);
  module.def("fit", &fit);
  module.def("cascade", &cascade);
}

}  // namespace holdfast::python
