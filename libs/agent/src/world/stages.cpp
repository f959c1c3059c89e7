// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/world/stages.hpp"

#include "algebra/scalar.hpp"
#include "holdfast/agent/cells/feet.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "holdfast/mechanics/lattice_beam.hpp"

namespace holdfast::agent {
namespace {

using base::Cell;
using base::Direction;
using Kind = StepWord::Kind;

constexpr std::uint8_t bit(int index) { return static_cast<std::uint8_t>(1U << unsigned(index)); }

/// What is worse, the larger.
int severity(Verdict verdict) {
  switch (verdict) {
    case Verdict::kUnstable:
      return 3;
    case Verdict::kOverload:
      return 2;
    case Verdict::kUndecided:
      return 1;
    default:
      return 0;
  }
}

using Vector = std::array<double, 3>;

/// Facets whose distances to a group differ by less than this share of a pitch, squared, are
/// equally near.
constexpr double kNearestTie = 1e-6;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double square_between(const Vector& a, const Vector& b) {
  const Vector apart = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return dot(apart, apart);
}

/// A way in axial coordinates, in cells of FeetCheck (floor_place()).
Cell floor_way(const base::Lattice& lattice, const Cell& way) {
  if (lattice.shear_x != 0 || lattice.shear_y != 0) {
    return {2 * way.x + lattice.shear_x * way.z, 2 * way.y + lattice.shear_y * way.z, way.z};
  }
  return lattice == base::kHexagonalPrism ? Cell{2 * way.x + way.y, way.y, way.z} : way;
}

}  // namespace

// ---- What this module was told.

void Stages::tell(std::uint8_t index, std::uint8_t total, const StepWord& word) {
  if (index == 0 || total != told_total_ || is_known_) {
    forget_told(false);
  }
  told_total_ = total;
  if (total > kWordCountMax || index >= total || !is_possible(word)) {
    return;  // Such a plan is never whole.
  }
  words_[index] = word;
  told_ = static_cast<std::uint16_t>(told_ | 1U << index);
}

void Stages::forget_told(bool only_known) {
  if (!only_known || is_known_) {
    told_ = 0;
    told_total_ = 0;
    is_known_ = false;
  }
}

// ---- What the robot has learned.

void Stages::leave(const Round& round) {
  learned_ = 0;
  total_ = 0;
  is_disputed_ = false;
  stage_ = Stage::kNone;
  split_ = split_round_ == round ? split_ : Stage::kNone;
  scene_ = 0;
}

void Stages::learn(std::uint8_t index, std::uint8_t total, const StepWord& word) {
  total_ = total;
  learned_ = static_cast<std::uint8_t>(index + 1);
  const bool was_told = (told_ >> index & 1U) != 0;
  if (told_ != 0 && (told_total_ != total || (was_told && !(words_[index] == word)))) {
    is_disputed_ = true;
  } else {
    words_[index] = word;
  }
  is_known_ = is_known_ || learned_ == total_;
}

Report Stages::report(std::uint8_t index, const StageSite& site) const {
  Report report{.flags = is_disputed_ ? kDisputed : std::uint8_t{0}};
  const auto next = static_cast<std::uint8_t>(index == kNoWord ? 0 : index + 1);
  if (index != kNoWord && next == total_) {
    for (int i = 0; i < total_; ++i) {
      const StepWord& mine = word(i);
      const bool is_named = mine.cell == site.cell && mine.kind != Kind::kAttach;
      const bool is_denied = is_named ? !fits(mine, site) : is_in_the_way(mine, site);
      report.flags = static_cast<std::uint8_t>(report.flags | (is_denied ? kDenied : 0U));
      report.count += is_named ? 1 : 0;
    }
    report.flags = static_cast<std::uint8_t>(report.flags | (split_ != Stage::kNone ? kSplit : 0U));
    report.mask = static_cast<std::uint8_t>(split_);
  } else if (next < kWordCountMax && (told_ >> next & 1U) != 0) {
    report.flags = static_cast<std::uint8_t>(report.flags | kFound);
    report.cell = words_[next].cell;
    report.number = bits_of(words_[next]);
    report.extent = told_total_;
  }
  return report;
}

/// What is said of this module must be possible here.
bool Stages::fits(const StepWord& word, const StageSite& site) const {
  const bool leaves = word.kind == Kind::kDetach || word.kind == Kind::kMove;
  if (leaves && (site.is_fixed || find(word.kind, site.cell) != &word ||
                 (word.kind == Kind::kMove && find(Kind::kDetach, site.cell) != nullptr))) {
    return false;  // It is held, or goes twice.
  }
  return word.kind == Kind::kCarry || site.used.has(static_cast<Direction>(word.face));
}

/// A module that stays in a cell that another one needs, or touches what does not move there.
bool Stages::is_in_the_way(const StepWord& word, const StageSite& site) const {
  const bool stays =
      find(Kind::kMove, site.cell) == nullptr && find(Kind::kDetach, site.cell) == nullptr;
  if (!stays || (word.kind != Kind::kMove && word.kind != Kind::kAttach)) {
    return false;
  }
  const auto is_taken = [&](const Cell& cell) {
    bool is_obstacle = site.is_standing && cell.z < site.cell.z;
    for (const Direction face : site.touching) {
      is_obstacle = is_obstacle || cell == base::neighbour(*lattice_, site.cell, face);
    }
    return cell == site.cell || is_obstacle;
  };
  if (word.kind == Kind::kAttach) {
    return is_taken(word.cell);
  }
  const auto first = static_cast<Direction>(word.first);
  return is_taken(base::neighbour(*lattice_, word.cell, first)) ||
         is_taken(target_of(*lattice_, word));
}

bool Stages::is_whole(std::uint32_t confirmed_count) const {
  std::uint32_t named_count = 0;
  for (int i = 0; i < total_; ++i) {
    const StepWord& mine = word(i);
    named_count += mine.kind == Kind::kAttach ? 0 : 1;
    const StepWord* mover = mover_of(mine.group);
    if (mine.kind == Kind::kMove && (mine.first != mover->first || mine.second != mover->second)) {
      return false;
    }
  }
  for (std::uint8_t group = 0; group < kGroupCount; ++group) {
    const StepWord* mover = mover_of(group);
    for (int waypoint = 0; mover != nullptr && waypoint < waypoint_count(*mover); ++waypoint) {
      if (carrier_count(group, waypoint) == 0) {
        return false;
      }
    }
  }
  return !is_disputed_ && confirmed_count == named_count && scene_count(Stage::kShift) <= kSceneMax;
}

const StepWord* Stages::find(Kind kind, const Cell& cell) const {
  for (int i = 0; i < total_; ++i) {
    if (word(i).kind == kind && word(i).cell == cell) {
      return &word(i);
    }
  }
  return nullptr;
}

// ---- The stage that is judged.

void Stages::enter(Stage stage, std::uint8_t scene) {
  if (stage == Stage::kRelease && scene == 0) {
    answers_ = {};
  }
  stage_ = stage;
  scene_ = scene;
}

void Stages::note(Stage stage, const Answer& answer) {
  Answer& worst = answers_[at(stage)];
  if (scene_ == 0) {
    worst = answer;
    return;
  }
  const bool has_ratio = answer.verdict == Verdict::kSafe || answer.verdict == Verdict::kOverload;
  const bool is_worse = has_ratio && answer.load_ratio_max > worst.load_ratio_max;
  const int limit = (is_worse ? answer : worst).remarks & kLimitBits;
  worst.remarks = static_cast<std::uint8_t>(limit | ((worst.remarks | answer.remarks) & kGapOpens));
  if (is_worse) {
    worst.worst_cell = answer.worst_cell;
    worst.worst_direction = answer.worst_direction;
    worst.load_ratio_max = answer.load_ratio_max;
  }
  if (severity(answer.verdict) > severity(worst.verdict)) {
    worst.verdict = answer.verdict;
    worst.reason = answer.reason;
  }
}

Stage Stages::failing() const {
  Stage undecided = Stage::kNone;
  for (const Stage stage : {Stage::kRelease, Stage::kShift, Stage::kConnect}) {
    const int bad = severity(answer(stage).verdict);
    if (bad > 1) {
      return stage;
    }
    undecided = bad == 1 && undecided == Stage::kNone ? stage : undecided;
  }
  return undecided;
}

Answer Stages::overall() const {
  const Stage bad = failing();
  if (bad != Stage::kNone) {
    return answer(bad);
  }
  Answer worst = answer(Stage::kRelease);
  for (const Stage stage : {Stage::kShift, Stage::kConnect}) {
    worst = answer(stage).load_ratio_max > worst.load_ratio_max ? answer(stage) : worst;
  }
  return worst;
}

// ---- What the stage makes of the module in a cell.

bool Stages::is_target(const Cell& cell) const {
  for (int i = 0; i < total_; ++i) {
    const StepWord& mine = word(i);
    if ((mine.kind == Kind::kMove && target_of(*lattice_, mine) == cell) ||
        (mine.kind == Kind::kAttach && mine.cell == cell)) {
      return true;
    }
  }
  return false;
}

/// The word by which the module of a cell is gone in this stage. Where another one comes to its
/// place nothing is changed by that in the end but what it weighs: all modules are alike.
const StepWord* Stages::leaving(const Cell& cell) const {
  if (stage_ != Stage::kShift && stage_ != Stage::kConnect) {
    return nullptr;
  }
  const StepWord* word = find(Kind::kMove, cell);
  word = word == nullptr ? find(Kind::kDetach, cell) : word;
  const bool is_refilled = stage_ == Stage::kConnect && word != nullptr && is_target(cell);
  return is_refilled ? nullptr : word;
}

/// A module that is to move lets go of all but its group and the carriers of that.
bool Stages::lets_go(const Cell& from, const Cell& other) const {
  const StepWord* mover = find(Kind::kMove, from);
  if (mover == nullptr) {
    return false;
  }
  for (int i = 0; i < total_; ++i) {
    const StepWord& kept = word(i);
    const bool is_kind = kept.kind == Kind::kMove || kept.kind == Kind::kCarry;
    if (is_kind && kept.group == mover->group && kept.cell == other) {
      return false;
    }
  }
  return true;
}

bool Stages::is_off(const Cell& cell, Direction face) const {
  const Cell other = base::neighbour(*lattice_, cell, face);
  const auto there = static_cast<std::uint8_t>(base::opposite(face));
  const StepWord* mine = leaving(cell);
  const StepWord* theirs = leaving(other);
  if (mine != nullptr || theirs != nullptr) {
    const bool is_kept = (mine != nullptr && mine->face == static_cast<std::uint8_t>(face)) ||
                         (theirs != nullptr && theirs->face == there);
    return !is_kept;
  }
  for (int i = 0; i < total_; ++i) {
    const StepWord& off = word(i);
    const bool is_here = off.cell == cell && off.face == static_cast<std::uint8_t>(face);
    const bool is_there = off.cell == other && off.face == there;
    if (off.kind == Kind::kOff && (is_here || is_there) &&
        (off.mask & bit(static_cast<int>(stage_) - 1)) != 0) {
      return true;
    }
  }
  return stage_ == Stage::kRelease && (lets_go(cell, other) || lets_go(other, cell));
}

Faces Stages::hidden(const Cell& cell) const {
  Faces faces;
  for (const Direction face : base::directions(*lattice_)) {
    faces.set(face, stage() != Stage::kNone && is_off(cell, face));
  }
  return faces;
}

bool Stages::find_planned(bool has_last, const Cell& last, Cell& cell) const {
  bool is_found = false;
  for (int i = 0; i < total_ && stage() == Stage::kConnect; ++i) {
    const StepWord& mine = word(i);
    const Cell there = mine.kind == Kind::kMove ? target_of(*lattice_, mine) : mine.cell;
    const bool comes = mine.kind == Kind::kMove || mine.kind == Kind::kAttach;
    const bool is_refilled =
        find(Kind::kMove, there) != nullptr || find(Kind::kDetach, there) != nullptr;
    if (comes && !is_refilled && (!has_last || there > last) && (!is_found || there < cell)) {
      cell = there;
      is_found = true;
    }
  }
  return is_found;
}

const StepWord* Stages::mover_of(std::uint8_t group) const {
  for (int i = 0; i < total_; ++i) {
    if (word(i).kind == Kind::kMove && word(i).group == group) {
      return &word(i);
    }
  }
  return nullptr;
}

/// The carrier word of a group at a waypoint, or at its last one if it has arrived; null behind the
/// last choice.
const StepWord* Stages::carrier(std::uint8_t group, int waypoint, int choice) const {
  const StepWord* mover = mover_of(group);
  const int last = waypoint_count(*mover) - 1;
  const std::uint8_t here = bit(waypoint < last ? waypoint : last);
  for (int i = 0; i < total_; ++i) {
    const StepWord& mine = word(i);
    if (mine.kind == Kind::kCarry && mine.group == group && (mine.mask & here) != 0 &&
        choice-- == 0) {
      return &mine;
    }
  }
  return nullptr;
}

int Stages::carrier_count(std::uint8_t group, int waypoint) const {
  int count = 0;
  while (carrier(group, waypoint, count) != nullptr) {
    ++count;
  }
  return count;
}

int Stages::scene_count(Stage stage) const {
  if (stage != Stage::kShift) {
    return 1;
  }
  int waypoints = 1;
  for (std::uint8_t group = 0; group < kGroupCount; ++group) {
    const StepWord* mover = mover_of(group);
    const int mine = mover == nullptr ? 1 : waypoint_count(*mover);
    waypoints = mine > waypoints ? mine : waypoints;
  }
  int count = 0;
  for (int waypoint = 0; waypoint < waypoints; ++waypoint) {
    int here = 1;
    for (std::uint8_t group = 0; group < kGroupCount; ++group) {
      here *= mover_of(group) == nullptr ? 1 : carrier_count(group, waypoint);
    }
    count += here;
  }
  return count;
}

/// Finds which waypoint and which carriers the scene is of.
bool Stages::find_scene(int& waypoint, Choice& choice) const {
  int rest = scene_;
  for (waypoint = 0; waypoint < kWaypointMax; ++waypoint) {
    int here = 1;
    for (std::uint8_t group = 0; group < kGroupCount; ++group) {
      here *= mover_of(group) == nullptr ? 1 : carrier_count(group, waypoint);
    }
    if (rest >= here) {
      rest -= here;
      continue;
    }
    for (std::uint8_t group = 0; group < kGroupCount; ++group) {
      const int count = mover_of(group) == nullptr ? 1 : carrier_count(group, waypoint);
      choice[group] = static_cast<std::uint8_t>(rest % count);
      rest /= count;
    }
    return true;
  }
  return false;
}

/// Does the module in `cell` carry the group in this scene? Then `waypoint` is where.
bool Stages::carries(std::uint8_t group, const Cell& cell, int& waypoint) const {
  Choice choice{};
  return stage() == Stage::kShift && mover_of(group) != nullptr && find_scene(waypoint, choice) &&
         carrier(group, waypoint, choice[group])->cell == cell;
}

/// What a module weighs, in units.
std::int32_t Stages::mass_of(const Cell& cell) const {
  if (environment_ == nullptr) {
    return 1;
  }
  Surroundings there{.environment = environment_};
  environment_->describe(environment_->map, cell, there);
  return there.mass;
}

/// What acts on a module from outside.
base::Vec6<double> Stages::load_of(const Cell& cell, const Setup& setup) const {
  if (environment_ == nullptr) {
    return {0, 0, -setup.weight_n};
  }
  Surroundings there{.environment = environment_};
  environment_->describe(environment_->map, cell, there);
  return there.load;
}

/// Twice the way from a cell to a moved module, axial coordinates.
Cell Stages::doubled_apart(const StepWord& move, int waypoint, const Cell& from) const {
  const Cell way = doubled_way(*lattice_, move, waypoint);
  const Cell here = base::axial_of(*lattice_, from);
  const Cell there = base::axial_of(*lattice_, move.cell);
  return {2 * (there.x - here.x) + way.x, 2 * (there.y - here.y) + way.y,
          2 * (there.z - here.z) + way.z};
}

/// The place seen from there in the global frame, in pitches.
Stages::Place Stages::place_from(const StepWord& move, int waypoint, const Cell& from) const {
  const Vector doubled = base::place_of(*lattice_, doubled_apart(move, waypoint, from));
  return {doubled[0] / 2, doubled[1] / 2, doubled[2] / 2};
}

HungMass Stages::hung_mass(const Cell& cell, const Setup& setup) const {
  HungMass sum;
  if (setup.has_plane) {
    return hung_on_plane(cell, setup);
  }
  for (std::uint8_t group = 0; group < kGroupCount; ++group) {
    int waypoint = 0;
    if (!carries(group, cell, waypoint)) {
      continue;
    }
    for (int i = 0; i < total_; ++i) {
      if (word(i).kind != Kind::kMove || word(i).group != group) {
        continue;
      }
      const std::int32_t mass = mass_of(word(i).cell);
      const Cell place = floor_way(*lattice_, doubled_apart(word(i), waypoint, cell));
      sum.mass += 2 * mass;
      sum.moment[0] += std::int64_t{mass} * place.x;
      sum.moment[1] += std::int64_t{mass} * place.y;
      sum.moment[2] += std::int64_t{mass} * place.z;
    }
  }
  return sum;
}

/// What acts on a group, about a point given from the node of its carrier, in pitches.
base::Vec6<double> Stages::group_load(std::uint8_t group, int waypoint, const Cell& cell,
                                      const Place& point, const Setup& setup) const {
  base::Vec6<double> sum{};
  for (int i = 0; i < total_; ++i) {
    if (word(i).kind != Kind::kMove || word(i).group != group) {
      continue;
    }
    base::Vec6<double> load = load_of(word(i).cell, setup);
    const Vector place = place_from(word(i), waypoint, cell);
    const double x = setup.section.length * (place[0] - point[0]);
    const double y = setup.section.length * (place[1] - point[1]);
    const double z = setup.section.length * (place[2] - point[2]);
    load[3] += y * load[2] - z * load[1];
    load[4] += z * load[0] - x * load[2];
    load[5] += x * load[1] - y * load[0];
    base::add_to(sum, load);
  }
  return sum;
}

/// All that hangs on a module, about its node.
base::Vec6<double> Stages::hung_load(const Cell& cell, const Setup& setup) const {
  base::Vec6<double> sum{};
  for (std::uint8_t group = 0; group < kGroupCount; ++group) {
    int waypoint = 0;
    if (carries(group, cell, waypoint)) {
      base::add_to(sum, group_load(group, waypoint, cell, {}, setup));
    }
  }
  return sum;
}

/// What hangs there presses on the plane of supports, and has moments about the foot of the module
/// there, as the module's own load is counted: rounded once more, in the place of a module that is
/// gone.
HungMass Stages::hung_on_plane(const Cell& cell, const Setup& setup) const {
  const base::Vec6<double> load = hung_load(cell, setup);
  const auto& [x, y] = setup.plane_axes;
  const Vector out = {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2],
                      x[0] * y[1] - x[1] * y[0]};
  const Vector force = {load[0], load[1], load[2]};
  const Vector torque = {load[3], load[4], load[5]};
  const double pitch = setup.section.length;
  const double height =
      pitch * (dot(out, base::node_place(*lattice_, cell)) - environment_->plane_height);
  const double unit = environment_->plane_unit_n;
  const auto rounded = [](double value) {
    return static_cast<std::int64_t>(value + (value < 0 ? -0.5 : 0.5));
  };
  const double moment_unit = unit * pitch / kPlaneParts;
  return {.mass = static_cast<std::int32_t>(rounded(-dot(out, force) / unit)),
          .moment = {rounded((height * dot(x, force) + dot(y, torque)) / moment_unit),
                     rounded((height * dot(y, force) - dot(x, torque)) / moment_unit), 0}};
}

/// A module that is gone has no load: of one with surroundings they know it, on another one its
/// weight is taken off.
void Stages::hang(const Cell& cell, const Setup& setup) {
  hung_ = hung_load(cell, setup);
  hung_[2] += is_gone(cell) && environment_ == nullptr ? setup.weight_n : 0;
}

/// The load ratio of a group's load in the middle of its carrier's facet: tension along the facet's
/// direction, and bending about the two axes across it. `held`: the module that the facet holds.
mechanics::LimitRatio Stages::ratio_through(Direction face, const StepWord& held, int waypoint,
                                            const Cell& cell, const Setup& setup) const {
  const Vector along = base::unit_vector(*lattice_, face);
  const base::Vec6<double> load =
      group_load(held.group, waypoint, cell, {along[0] / 2, along[1] / 2, along[2] / 2}, setup);
  const auto frame = mechanics::rotation_along<double>(*lattice_, face);
  const Vector force = {load[0], load[1], load[2]};
  const Vector torque = {load[3], load[4], load[5]};
  const base::Vec6<double> middle = {dot(force, frame[0]),  dot(force, frame[1]),
                                     dot(force, along),     dot(torque, frame[0]),
                                     dot(torque, frame[1]), dot(torque, frame[2])};
  if (environment_ != nullptr && environment_->law != nullptr) {
    const mechanics::ConnectorLaw& law =
        environment_->law(environment_->map, cell, face, held.cell);
    return mechanics::load_ratio(law, mechanics::connection_force(law, middle, length));
  }
  return {.ratio = mechanics::load_ratio(mechanics::connection_load(middle), setup.facet_mm,
                                         strength_n(setup, face))};
}

/// Facets of the carrier that are as near to a module of the group as the nearest.
bool Stages::find_hanging(std::uint8_t group, const Cell& cell, const Setup& setup,
                          Hanging& worst) const {
  int waypoint = 0;
  if (!carries(group, cell, waypoint)) {
    return false;
  }
  const auto distance = [&](int i, Direction face) {
    return square_between(place_from(word(i), waypoint, cell), base::unit_vector(*lattice_, face));
  };
  const auto is_member = [&](int i) {
    return word(i).kind == Kind::kMove && word(i).group == group;
  };
  double nearest = 1e30;
  for (int i = 0; i < total_; ++i) {
    for (const Direction face : base::directions(*lattice_)) {
      const double apart = is_member(i) ? distance(i, face) : nearest;
      nearest = apart < nearest ? apart : nearest;
    }
  }
  bool is_found = false;
  for (int i = 0; i < total_; ++i) {
    for (const Direction face : base::directions(*lattice_)) {
      if (!is_member(i) || distance(i, face) > nearest + kNearestTie) {
        continue;
      }
      const mechanics::LimitRatio here = ratio_through(face, word(i), waypoint, cell, setup);
      if (!is_found || !(here.ratio <= worst.worst.ratio)) {
        worst = {.direction = face, .worst = here};
      }
      is_found = true;
    }
  }
  return is_found;
}

bool Stages::find_limit(const Cell& cell, const Setup& setup, Direction direction, double ratio,
                        mechanics::Limit& limit) const {
  bool is_found = false;
  visit_hanging(cell, setup, [&](const Hanging& hanging) {
    if (hanging.direction == direction && hanging.worst.ratio == ratio) {
      limit = hanging.worst.limit;
      is_found = true;
    }
  });
  return is_found;
}

}  // namespace holdfast::agent
