// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

/// A proof of what a robot's connections carry, and its checker. This room knows nothing of the
/// solvers and shares no code with them; docs/proof.md has the theorems.
///
/// Units: a force is a multiple of one module's weight W, a length of half the pitch L, a
/// displacement of W L / (E A). So every lever is 1, the axial stiffness is 1, and neither W nor E
/// matters to balance and compatibility: both hold exactly, in integers that count 2^-bits.
namespace holdfast::certificate {

/// Counts 2^-bits.
__extension__ using Integer = __int128;

/// Displacement and rotation of a module, global frame: ux uy uz, and tx ty tz times half a pitch.
using Six = std::array<Integer, 6>;

/// Displacements of all modules, by module.
using Field = std::vector<Six>;

enum class Law : std::uint8_t {
  kBonded,       ///< Supports neither lift nor tilt.
  kRegularised,  ///< Eqs. (9)-(12) of [Piranda 2021].
  kUnilateral,   ///< Eqs. (6)-(8), without weak springs.
};

/// N, mm, kg, s. Each number stands for all within one unit in its last place.
struct Material {
  double pitch = 0;
  double facet = 0;
  double area = 0;
  double moment_x = 0;
  double moment_y = 0;
  double torsion = 0;
  double poisson = 0;
  double mass = 0;
  double gravity = 0;
  double strength_vertical = 0;
  double strength_lateral = 0;
  double gamma = 0;
};

/// The state of a facet on the ground: pressed or not, and the signs of the torques about x and y
/// over which it tilts, or 0.
struct State {
  bool is_pressed = true;
  int tilt_x = 0;
  int tilt_y = 0;

  bool is_tilted() const { return is_pressed && (tilt_x != 0 || tilt_y != 0); }
};

/// A module rests on the ground if it is in the support layer and not fixed.
struct Module {
  std::array<std::int32_t, 3> cell{};
  bool is_fixed = false;
  State state;  ///< Of modules on the ground only.
};

struct Certificate {
  std::string name;  ///< The robot's, on one line; may be empty.
  Law law = Law::kBonded;
  Material material;
  std::int32_t support_z = 0;
  int bits = 0;
  std::vector<Module> modules;
  std::size_t planned_count = 0;  ///< So many of `modules`, the last, are planned.
  /// The first: displacements under the weight. Under the regularised law one more for every
  /// facet that tilts, in the modules' order: displacements where its moment is greater by 1.
  std::vector<Field> fields;
};

inline constexpr int kBitsMax = 64;

/// Larger numbers could overflow when some are added up.
inline constexpr int kMagnitudeBitsMax = 116;

/// The certificate as text, see docs/formats.md.
std::string write(const Certificate& certificate);

struct Reading {
  Certificate certificate;
  std::string fault;  ///< Empty if it could be read.
};

Reading read(std::string_view text);

/// The number that identifies a robot: SHA-256, hexadecimal, of its material, support level and
/// modules in any order, as docs/formats.md says. Neither its name nor what is proved changes it.
std::string digest(const Certificate& certificate);

/// Words for the robot of which something is proved, as all programs say it, "arm, 13 modules, 2 of
/// them planned".
std::string robot_words(std::string_view name, std::size_t module_count, std::size_t planned_count);

struct Verification {
  bool is_proved = false;
  std::string reason;     ///< Why not.
  double ratio_low = 0;   ///< The largest load ratio is at least this,
  double ratio_high = 0;  ///< and at most this.
  std::size_t connection_count = 0;
  /// The centre of mass lies strictly inside the support polygon, or a fixed module holds the
  /// robot.
  bool is_standing = false;
  /// The centre of mass surely lies beyond the support polygon, and no module is fixed. Under the
  /// bonded law, by which such a robot stands: it topples if it only rests on the ground.
  bool topples = false;
  std::size_t facet_count = 0;
};

/// Proves that the robot has an equilibrium under its law in which the largest load ratio lies in
/// the range, or says why that is not proved. Time and memory are linear in the fields.
Verification verify(const Certificate& certificate);

/// The distance of a field from balance.
struct Residual {
  std::vector<std::array<double, 6>> force;  ///< By module, 2^-bits; zero at fixed ones.
  double largest = 0;
  double rounding = 0;  ///< What is below this is rounding.
};

/// Computes what a field leaves unbalanced, for those who make certificates; not proved. The fields
/// may change between two calls, all else may not.
class Residuals {
 public:
  /// Keeps a reference.
  explicit Residuals(const Certificate& certificate);
  ~Residuals();

  Residual of(std::size_t field) const;

 private:
  struct Parts;

  std::unique_ptr<Parts> parts_;
};

}  // namespace holdfast::certificate
