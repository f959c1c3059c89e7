// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "holdfast/reliability.hpp"

namespace holdfast {
namespace {

using verdict::StrengthScatter;

/// What kinds of modules state, by their index in the robot: the modules without a kind of their
/// own, then the document's kinds.
std::vector<double> by_kind(const io::Extension& extension, std::size_t kind_count,
                            std::optional<double> io::Scatter::*cv) {
  const double common = (extension.scatter.*cv).value_or(0);
  std::vector<double> list(std::max<std::size_t>(1, kind_count), common);
  for (std::size_t i = 0; i + 1 < list.size() && i < extension.kinds.size(); ++i) {
    list[i + 1] = (extension.kinds[i].scatter.*cv).value_or(common);
  }
  return list;
}

std::vector<double> masses(const model::Robot& robot, const std::vector<double>& of_kind) {
  std::vector<double> list;
  if (std::ranges::any_of(of_kind, [](double cv) { return cv > 0; })) {
    for (const model::Module& module : robot.modules()) {
      list.push_back(of_kind[module.kind]);
    }
  }
  return list;
}

/// What a connection states that the document lists by itself; null if it lists none such.
const io::Scatter* own_scatter(const io::Extension& extension, const model::Robot& robot,
                               const model::Connection& pair) {
  const std::int32_t tag = robot.connector_tag(pair);
  return tag == model::OwnConnector::kNoTag ? nullptr
                                            : &extension.connections[base::at(tag)].scatter;
}

template <class Value>
bool are_all(const std::vector<Value>& list, const Value& value) {
  return std::ranges::count(list, value) == static_cast<std::ptrdiff_t>(list.size());
}

/// Sets how the strength of each connection scatters, or how all do. A connection that states
/// nothing scatters as the one of its modules that scatters more.
void take_strengths(const io::Extension& extension, const model::Robot& robot,
                    const ScatterWish& wish, StrengthScatter& scatter) {
  const std::vector<double> of_kind =
      by_kind(extension, robot.kinds().size(), &io::Scatter::strength_cv);
  scatter.cv = std::max(verdict::kCvMin, wish.strength_cv.value_or(of_kind.front()));
  if (extension.connections.empty() && are_all(of_kind, of_kind.front())) {
    return;
  }
  std::vector<double> cvs;
  std::vector<verdict::StrengthDistribution> distributions;
  for (const model::Connection& pair : robot.connections()) {
    const io::Scatter* const own = own_scatter(extension, robot, pair);
    const double cv = std::max(of_kind[robot.modules()[base::at(pair.a)].kind],
                               of_kind[robot.modules()[base::at(pair.b)].kind]);
    const double stated = own == nullptr ? cv : own->strength_cv.value_or(cv);
    cvs.push_back(std::max(verdict::kCvMin, wish.strength_cv.value_or(stated)));
    distributions.push_back(own == nullptr || wish.distribution
                                ? scatter.distribution
                                : own->distribution.value_or(scatter.distribution));
  }
  scatter.cv = cvs.empty() ? scatter.cv : *std::ranges::max_element(cvs);
  if (!are_all(cvs, scatter.cv)) {
    scatter.own_cv = std::move(cvs);
  }
  if (!are_all(distributions, scatter.distribution)) {
    scatter.own_distribution = std::move(distributions);
  }
}

/// Checks a robot with other masses.
std::optional<verdict::Assessment> check_with(model::RobotSpec spec, const model::Robot& robot,
                                              std::span<const double> masses_kg,
                                              const CheckOptions& options) {
  spec.own_masses.clear();
  for (std::size_t i = 0; i < masses_kg.size(); ++i) {
    spec.own_masses.push_back({robot.modules()[i].cell, masses_kg[i]});
  }
  const auto changed = model::Robot::create(spec, options.thread_count);
  return changed ? std::optional(check(changed.value(), options).assessment) : std::nullopt;
}

/// The assessment with load ratios that refer to strengths that no safety factor has divided.
verdict::Assessment with_strengths_as_given(verdict::Assessment assessment, double safety_factor) {
  const auto scale = [safety_factor](verdict::LoadRange& range) {
    range = {.low = range.low / safety_factor, .high = range.high / safety_factor};
  };
  for (verdict::ConnectionResult& connection : assessment.connections) {
    connection.load_ratio /= safety_factor;
  }
  if (assessment.load_ratio_max) {
    *assessment.load_ratio_max /= safety_factor;
  }
  scale(assessment.load_ratio_range);
  if (assessment.several) {
    scale(assessment.several->regularised);
    assessment.several->error /= safety_factor;
    if (assessment.several->unilateral) {
      scale(*assessment.several->unilateral);
    }
  }
  return assessment;
}

}  // namespace

std::optional<StrengthScatter> find_scatter(const Structure& structure, const ScatterWish& wish) {
  return find_scatter(structure.document.extension, structure.robot, wish);
}

std::optional<StrengthScatter> find_scatter(const io::Extension& extension,
                                            const model::Robot& robot, const ScatterWish& wish) {
  const std::size_t kinds = robot.kinds().size();
  std::vector<double> mass_cvs = by_kind(extension, kinds, &io::Scatter::mass_cv);
  mass_cvs = wish.mass_cv ? std::vector(mass_cvs.size(), *wish.mass_cv) : mass_cvs;
  StrengthScatter scatter;
  scatter.distribution = wish.distribution.value_or(
      extension.scatter.distribution.value_or(verdict::StrengthDistribution::kLognormal));
  take_strengths(extension, robot, wish, scatter);
  scatter.mass_cv = masses(robot, mass_cvs);
  scatter.common_cv = wish.common_cv;
  const bool is_any = scatter.cv > verdict::kCvMin || wish.strength_cv || wish.common_cv > 0 ||
                      !scatter.mass_cv.empty();
  return is_any ? std::optional(scatter) : std::nullopt;
}

std::optional<verdict::Reliability> find_reliability(const AssessedRobot& assessed,
                                                     const StrengthScatter& scatter,
                                                     const CheckOptions& options) {
  const auto& [robot, assessment, spec, safety_factor, likeliest_max] = assessed;
  verdict::SampledMasses sampled;
  if (!scatter.mass_cv.empty()) {
    const CheckOptions how{.is_bonded = assessment.contact_model == verdict::ContactModel::kBonded,
                           .thread_count = options.thread_count,
                           .memory_bytes_max = options.memory_bytes_max};
    verdict::MassSampling sampling;
    sampling.equilibrium.thread_count = options.thread_count;
    sampling.equilibrium.memory_bytes_max = options.memory_bytes_max;
    if (spec != nullptr) {
      sampling.check = [&, made_of = spec](std::span<const double> masses_kg) {
        return check_with(*made_of, assessed.robot, masses_kg, how);
      };
    }
    sampled = verdict::sample_masses(robot, assessment, scatter.mass_cv, sampling);
  }
  if (safety_factor == 1) {
    return verdict::find_reliability(assessment, scatter, sampled, likeliest_max);
  }
  for (verdict::LoadCase& one : sampled.cases) {
    for (double& ratio : one.ratios) {
      ratio /= safety_factor;
    }
  }
  return verdict::find_reliability(with_strengths_as_given(assessment, safety_factor), scatter,
                                   sampled, likeliest_max);
}

std::optional<verdict::Reliability> find_reliability(const Structure& structure,
                                                     const CheckResult& result,
                                                     const StrengthScatter& scatter,
                                                     const CheckOptions& options,
                                                     std::size_t likeliest_max) {
  const auto spec = scatter.mass_cv.empty() ? base::Result<model::RobotSpec>(model::RobotSpec())
                                            : io::make_spec(structure.document);
  const bool is_whole = spec && !spec.value().existing.empty();
  return find_reliability({.robot = structure.robot,
                           .assessment = result.assessment,
                           .spec = is_whole ? &spec.value() : nullptr,
                           .safety_factor = structure.document.extension.safety_factor,
                           .likeliest_max = likeliest_max},
                          scatter, options);
}

}  // namespace holdfast
