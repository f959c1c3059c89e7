// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/deformed_series.hpp"

#include <cmath>
#include <utility>

#include "holdfast/verdict/deformed.hpp"
#include "series/series_files.hpp"

namespace holdfast {
namespace {

/// Equilibria that differ by less are not written: the loads, and the largest way in pitches.
constexpr double kLeastGrowth = 0.01;
constexpr double kLeastWay = 0.25;

}  // namespace

class DeformedSeries::Body {
 public:
  Body(std::filesystem::path path, const Structure& structure, const CheckOptions& options)
      : files_(std::move(path)),
        structure_(structure),
        is_bonded_(options.is_bonded),
        thread_count_(options.thread_count),
        error_(files_.find_fault()) {}

  void add(const large::State& state, bool is_stable, int branch) {
    if (branch != branch_) {
      write_pending();
      branch_ = branch;
      last_.reset();
    }
    pending_ = Level{state, is_stable};
    if (!last_ || is_far(state) || state.factor == 1) {
      write_pending();
    }
  }

  std::optional<base::Error> finish() {
    write_pending();
    if (!error_ && files_.count() == 0) {
      return base::bad_input("there is no equilibrium in the deformed shape to be written");
    }
    return error_ ? error_ : files_.finish();
  }

 private:
  struct Level {
    large::State state;
    bool is_stable = true;
  };

  bool is_far(const large::State& state) const {
    const double way = state.displacement_max_mm - last_->second;
    return std::abs(state.factor - last_->first) >= kLeastGrowth ||
           std::abs(way) >= kLeastWay * structure_.robot.material().pitch_mm;
  }

  void write_pending() {
    if (!pending_ || error_) {
      return;
    }
    const Level level = *std::exchange(pending_, std::nullopt);
    const double factor = level.state.factor;
    const verdict::Assessment assessment =
        verdict::assess_state(structure_.robot, level.state, level.is_stable, is_bonded_);
    error_ = files_.add(files_.count(), 0, 1, [&](std::ostream& out) {
      io::write_deformed_vtu(out, structure_.robot, assessment, factor,
                             {.thread_count = thread_count_},
                             structure_.document.extension.obstacles);
    });
    last_ = {factor, level.state.displacement_max_mm};
  }

  SeriesFiles files_;
  const Structure& structure_;
  bool is_bonded_;
  int thread_count_;
  std::optional<base::Error> error_;
  int branch_ = 0;
  std::optional<Level> pending_;                   ///< What is not written yet.
  std::optional<std::pair<double, double>> last_;  ///< Factor and largest way that are.
};

DeformedSeries::DeformedSeries(std::filesystem::path path, const Structure& structure,
                               const CheckOptions& options)
    : body_(std::make_unique<Body>(std::move(path), structure, options)) {}

DeformedSeries::~DeformedSeries() = default;

std::function<void(const large::State&, bool, int)> DeformedSeries::writer() {
  return [this](const large::State& state, bool is_stable, int branch) {
    body_->add(state, is_stable, branch);
  };
}

std::optional<base::Error> DeformedSeries::finish() { return body_->finish(); }

}  // namespace holdfast
