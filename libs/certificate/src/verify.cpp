// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <utility>

#include "balance.hpp"
#include "standing.hpp"

namespace holdfast::certificate {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The absolute value, from below and from above.
bool is_surely_less(const Ball& a, const Ball& b) { return a.high() < b.low(); }

Ball absolute(const Ball& a) { return a.middle() < 0 ? Ball(0) - a : a; }

std::string find_form_fault(const Certificate& certificate) {
  const Material& m = certificate.material;
  for (const double value :
       {m.pitch, m.facet, m.area, m.moment_x, m.moment_y, m.torsion, m.mass, m.gravity,
        m.strength_vertical, m.strength_lateral, m.gamma, 1 + m.poisson, 1 - m.gamma}) {
    if (!(value > 0 && value < kInfinity)) {
      return "a number of the material is not allowed";
    }
  }
  if (certificate.bits < 0 || certificate.bits > kBitsMax) {
    return "the number of bits is not allowed";
  }
  std::size_t field_count = 1;
  for (const Module& module : certificate.modules) {
    const bool is_facet = !module.is_fixed && module.cell[2] == certificate.support_z;
    const State& state = module.state;
    if (std::max(std::abs(state.tilt_x), std::abs(state.tilt_y)) > 1 ||
        (certificate.law == Law::kBonded && (!state.is_pressed || state.is_tilted()))) {
      return "a contact state is not allowed";
    }
    field_count += certificate.law == Law::kRegularised && is_facet && state.is_tilted() ? 1 : 0;
  }
  if (certificate.fields.size() != field_count) {
    return "there is not one field for the weight and one for every facet that tilts";
  }
  for (const Field& field : certificate.fields) {
    if (field.size() != certificate.modules.size() ||
        !std::all_of(field.begin(), field.end(), is_small)) {
      return "a field has too few or too large numbers";
    }
    for (std::size_t i = 0; i < field.size(); ++i) {
      if (certificate.modules[i].is_fixed && field[i] != Six{}) {
        return "a fixed module moves";
      }
    }
  }
  return {};
}

/// docs/proof.md; e is the bound of the error of all forces, as the root of the sum of their
/// squares over the stiffness.
class Verifier {
 public:
  Verifier(const Certificate& certificate, const Structure& structure)
      : certificate_(certificate),
        structure_(structure),
        constants_(certificate.material),
        balancer_(certificate, structure, constants_) {}

  Verification run() {
    Verification result;
    result.connection_count = structure_.beams().size();
    result.facet_count = structure_.facets().size();
    const Standing standing = standing_of(certificate_, structure_, constants_);
    result.is_standing = standing.is_inside || certificate_.law == Law::kBonded;
    result.topples = standing.is_outside;
    result.reason = prove();
    if (result.reason.empty()) {
      bound_ratio(result);
    }
    return result;
  }

 private:
  const State& state_of(std::size_t facet) const {
    return certificate_.modules[structure_.facets()[facet]].state;
  }

  std::string prove() {
    if (certificate_.law == Law::kUnilateral && !constants_.is_facet_whole) {
      return "under the unilateral law only facets as wide as the pitch can be proved";
    }
    balance_ = balancer_.from_springs(0);
    balancer_.close(balance_);
    if (!balance_.fault.empty()) {
      return balance_.fault;
    }
    error_ = balancer_.mismatch(balance_, 0);
    if (certificate_.law == Law::kRegularised) {
      std::string fault = add_followers();
      return fault.empty() ? check_regularised_states() : fault;
    }
    return certificate_.law == Law::kUnilateral ? check_unilateral_states() : std::string();
  }

  /// Bounds how far the torque that follows at a facet is from c times its pressure, which is t_z.
  double follower_fault(const Balance& balance, std::size_t facet, double error,
                        Integer unit) const {
    const Ball pressure = ball_of(balance.facet[facet][kZ]).widened(error);
    return (ball_of(balance.follower[facet] - unit) - constants_.follow * pressure).largest();
  }

  /// The exact solution for the moments that the first field was given, and a combination of those
  /// of the others, with coefficients zeta, solve the law: (1 + Q) zeta = eps, |Q| <= alpha < 1.
  std::string add_followers() {
    const std::size_t count = structure_.facets().size();
    const Integer one = Integer{1} << certificate_.bits;
    std::vector<Ball> row(count);
    Ball spread;  // Of one unit of all zeta.
    for (std::size_t field = 1, own = 0; field < certificate_.fields.size(); ++field, ++own) {
      while (!state_of(own).is_tilted()) {
        ++own;
      }
      Balance response = balancer_.from_springs(field);
      balancer_.close(response);
      if (!response.fault.empty()) {
        return response.fault;
      }
      const double error = balancer_.mismatch(response, field);
      spread = spread + Ball(balancer_.magnitude(response)) / ball_of(one);
      for (std::size_t g = 0; g < count; ++g) {
        if (state_of(g).is_tilted()) {
          const double off = follower_fault(response, g, error, g == own ? one : 0);
          row[g] = row[g] + Ball(off) / ball_of(one);
        }
      }
    }
    double alpha = 0;
    double fault = 0;
    for (std::size_t g = 0; g < count; ++g) {
      if (state_of(g).is_tilted()) {
        alpha = std::max(alpha, row[g].high());
        fault = std::max(fault, follower_fault(balance_, g, error_, 0));
        if (!(row[g].high() < 0.5)) {
          return "the responses to what tilting facets do are not exact enough";
        }
      }
    }
    const Ball zeta = Ball(fault) / (Ball(1) - Ball(alpha));
    error_ = (Ball(error_) + zeta * spread).high();
    return {};
  }

  /// The trial force of Eq. (9) about the facet's centre: h times the exact gap. A spring k lets
  /// the gap be off by e over the root of k.
  Ball trial(std::size_t facet, std::size_t index) const {
    const Ball k = balancer_.facet_springs(state_of(facet))[index];
    const Ball h = constants_.h[kZ][index];
    const Ball weakness = Ball(1) / k;
    const double slack = (Ball(error_) * Ball(weakness.root_high())).high();
    const Six gap = facet_gap(certificate_.fields[0], structure_.facets()[facet]);
    return h * ball_of(gap[index]).widened(slack);
  }

  std::string check_regularised_states() const {
    for (std::size_t facet = 0; facet < structure_.facets().size(); ++facet) {
      const State& state = state_of(facet);
      const Ball limit = (Ball(0) - trial(facet, kZ)) * constants_.facet;
      bool is_proved = state.is_pressed ? limit.low() > 0 : limit.high() <= 0;
      for (const auto& [index, sign] : {std::pair(3, state.tilt_x), std::pair(4, state.tilt_y)}) {
        const Ball torque = trial(facet, static_cast<std::size_t>(index));
        const bool is_as_said =
            sign == 0 ? is_surely_less(absolute(torque), limit)
                      : is_surely_less(limit, Ball(static_cast<double>(sign)) * torque);
        is_proved = is_proved && (!state.is_pressed || is_as_said);
      }
      if (!is_proved) {
        return state_fault(facet);
      }
    }
    return {};
  }

  /// Pressed facets must press, as only then the ground holds them against slip; open ones must be
  /// open. What carries the rest must stay inside its cone.
  std::string check_unilateral_states() const {
    for (std::size_t facet = 0; facet < structure_.facets().size(); ++facet) {
      const State& state = state_of(facet);
      const Six& s = balance_.facet[facet];
      const Ball pressure = (Ball(0) - ball_of(s[kZ])).widened(error_);
      bool is_proved = state.is_pressed ? pressure.low() > 0 : is_open(facet);
      for (const std::size_t index : {std::size_t{3}, std::size_t{4}}) {
        if (state.is_pressed && !state.is_tilted()) {
          const double off = (Ball(error_) * Ball(constants_.h[kZ][index].root_high())).high();
          is_proved =
              is_proved && is_surely_less(absolute(ball_of(s[index])).widened(off), pressure);
        }
      }
      if (!is_proved) {
        return state_fault(facet);
      }
    }
    return {};
  }

  /// Whether all corners are off the ground. A unit force on one, and the torques on the way to the
  /// support, at most 2 k + 3 at the k-th spring: the square root of their energy, times twice the
  /// error, is how far the corner may be off.
  bool is_open(std::size_t facet) const {
    const std::size_t module = structure_.facets()[facet];
    Ball least = Ball(1);
    for (const Springs& springs : constants_.h) {
      for (const Ball& spring : springs) {
        least = spring.low() < least.low() ? spring : least;
      }
    }
    Ball energy;
    for (std::size_t k = 0; k <= structure_.depth()[module] + 1; ++k) {
      const Ball torque(2 * static_cast<double>(k) + 3);
      energy = energy + (Ball(1) + Ball(2) * torque * torque) / least;
    }
    const Ball slack = Ball(2) * Ball(error_) * Ball(energy.root_high());
    const Six gap = facet_gap(certificate_.fields[0], module);
    const Ball lift = ball_of(gap[kZ]) - absolute(ball_of(gap[3])) - absolute(ball_of(gap[4]));
    return is_surely_less(slack, lift);
  }

  std::string state_fault(std::size_t facet) const {
    const auto& cell = certificate_.modules[structure_.facets()[facet]].cell;
    return "the facet under (" + std::to_string(cell[0]) + "," + std::to_string(cell[1]) + "," +
           std::to_string(cell[2]) + ") is too near to another contact state, or is in one";
  }

  /// Eq. (17): (2 m / a + f_z) / F_max, here (m / facet + f) / strength. Its error is that of a
  /// linear form, by the inequality of Cauchy and Schwarz.
  void bound_ratio(Verification& result) const {
    const Ball unit = Ball(1) / ball_of(Integer{1} << certificate_.bits);
    bool is_finite = true;
    result.ratio_low = structure_.beams().empty() ? 0 : -kInfinity;
    result.ratio_high = result.ratio_low;
    for (std::size_t i = 0; i < structure_.beams().size(); ++i) {
      const auto axis = static_cast<std::size_t>(structure_.beams()[i].axis);
      const Springs& h = constants_.h[axis];
      const Six& s = balance_.beam[i];
      Ball ratio;
      for (const std::size_t across : {(axis + 1) % 3, (axis + 2) % 3}) {
        const Ball square = Ball(1) + h[3 + across] / constants_.facet / constants_.facet;
        const double off = (Ball(error_) * Ball(square.root_high())).high();
        const Ball sum = absolute(ball_of(s[3 + across])) / constants_.facet + ball_of(s[axis]);
        ratio = sum.widened(off) * unit / constants_.strength[axis];
        is_finite = is_finite && ratio.low() > -kInfinity && ratio.high() < kInfinity;
        result.ratio_low = std::max(result.ratio_low, ratio.low());
        result.ratio_high = std::max(result.ratio_high, ratio.high());
      }
    }
    result.is_proved = is_finite;
    result.reason = is_finite ? "" : "the bound is not finite";
  }

  const Certificate& certificate_;
  const Structure& structure_;
  Constants constants_;
  Balancer balancer_;
  Balance balance_;
  double error_ = 0;
};

}  // namespace

Verification verify(const Certificate& certificate) {
  Verification result;
  result.reason = find_form_fault(certificate);
  if (!result.reason.empty()) {
    return result;
  }
  const Structure structure(certificate);
  if (!structure.fault().empty()) {
    result.reason = structure.fault();
    return result;
  }
  return Verifier(certificate, structure).run();
}

}  // namespace holdfast::certificate
