// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "check_options.hpp"
#include "common.hpp"
#include "holdfast/cascade.hpp"
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

double share_of(double share, const char* what) {
  if (!(share >= verdict::kCvMin && share <= verdict::kCvMax)) {
    throw Error(std::string(what) + ": expected a share from 0.0001 to 1, found " +
                std::to_string(share));
  }
  return share;
}

std::string reliability(const SharedCheck& check, double scatter, double common,
                        const std::string& law) {
  const auto distribution = verdict::find_strength_distribution(law);
  if (!distribution) {
    throw Error("law: expected lognormal, normal or weibull, found '" + io::one_line(law) + "'");
  }
  const verdict::StrengthScatter how{.distribution = *distribution,
                                     .cv = share_of(scatter, "scatter"),
                                     .common_cv = common == 0 ? 0 : share_of(common, "common")};
  return object_of([&](io::JsonStream& json) {
    write_reliability_member(json, check->structure->robot, how,
                             find_reliability(check->result, how));
  });
}

std::string lose_one(const SharedStructure& structure, const std::vector<std::string>& parts,
                     double seconds, const py::handle& threads, const py::handle& memory,
                     bool is_bonded, py::object progress) {
  LoseOneOptions options;
  options.check = check_options(threads, memory, is_bonded);
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

std::string cascade(const SharedStructure& structure, const py::handle& threads,
                    const py::handle& memory, bool is_bonded, py::object progress) {
  const CheckOptions options = check_options(threads, memory, is_bonded);
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
  module.def("cascade", &cascade);
}

}  // namespace holdfast::python
