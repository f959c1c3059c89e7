// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "holdfast/base/cell.hpp"              // IWYU pragma: export
#include "holdfast/base/result.hpp"            // IWYU pragma: export
#include "holdfast/host/interruption.hpp"      // IWYU pragma: export
#include "holdfast/host/large_pages.hpp"       // IWYU pragma: export
#include "holdfast/host/output_file.hpp"       // IWYU pragma: export
#include "holdfast/host/text.hpp"              // IWYU pragma: export
#include "holdfast/io/beside_one.hpp"          // IWYU pragma: export
#include "holdfast/io/binary_structure.hpp"    // IWYU pragma: export
#include "holdfast/io/collapse.hpp"            // IWYU pragma: export
#include "holdfast/io/document.hpp"            // IWYU pragma: export
#include "holdfast/io/foreign_format.hpp"      // IWYU pragma: export
#include "holdfast/io/goal_shape.hpp"          // IWYU pragma: export
#include "holdfast/io/lattice_names.hpp"       // IWYU pragma: export
#include "holdfast/io/near_miss.hpp"           // IWYU pragma: export
#include "holdfast/io/picture.hpp"             // IWYU pragma: export
#include "holdfast/io/report.hpp"              // IWYU pragma: export
#include "holdfast/io/robot_description.hpp"   // IWYU pragma: export
#include "holdfast/large/follow.hpp"           // IWYU pragma: export
#include "holdfast/limit/limit_load.hpp"       // IWYU pragma: export
#include "holdfast/model/connected_parts.hpp"  // IWYU pragma: export
#include "holdfast/model/robot.hpp"            // IWYU pragma: export
#include "holdfast/model/robot_catalogue.hpp"  // IWYU pragma: export
#include "holdfast/proof/proof.hpp"            // IWYU pragma: export
#include "holdfast/verdict/assessment.hpp"     // IWYU pragma: export

/// The facade: load a structure or make a robot of cells, check it, show the answer. Everything an
/// application needs.
///
///     auto structure = holdfast::load_file("robot.xml");
///     if (!structure) { ... structure.error().message ... }
///     const holdfast::CheckResult result = holdfast::check(structure.value());
///     if (result.assessment.verdict == holdfast::verdict::Verdict::kSafe) { ... }
///
///     auto robot = holdfast::make_robot({.existing = cells, .planned = next});
///     if (robot) { ... holdfast::check(robot.value()) ... }
///
/// Cubes on a floor are made of their cells alone. Other lattices, obstacles, masses, loads,
/// gravity and limits of connections are members of model::RobotSpec, of which
/// model::Robot::create makes a robot as well:
///
///     holdfast::model::RobotSpec shelf{.existing = cells, .support_z = {}, .obstacles = wall};
///     auto robot = holdfast::model::Robot::create(shelf);
///
/// Robots that a program makes become structures, which find_next() takes, and documents, which
/// seek_order() and seek_moves() take, by way of io::Document:
///
///     holdfast::io::Document document;
///     for (const holdfast::base::Cell& cell : cells) {
///       document.modules.push_back({.cell = cell});
///     }
///     auto structure = holdfast::make_structure(document);
///
/// What an application may name of the rooms below is what is exported here and by the headers
/// beside this one. No function throws or prints; what a caller's own callbacks
/// throw, such as that of host::Interruptible, passes through, and ends the work. Units: N, mm, kg,
/// s. Frame: global, z up, one cell = one pitch.
namespace holdfast {

/// A structure that can be checked: what the file says and the robot that it means.
struct Structure {
  std::string name;  ///< The document's, or the file's without folder and ending.
  io::Document document;
  model::Robot robot;
  std::vector<std::string> warnings;
  io::ReportOrigin origin = {};  ///< What its reports say of where it is from.
};

/// A robot's cells where a program keeps them, in any order; as model::RobotSpec, but only looked
/// at.
struct RobotCells {
  std::span<const base::Cell> existing;
  std::span<const base::Cell> planned = {};        ///< Attached in the planned step, all at once.
  std::span<const base::Cell> fixed = {};          ///< Those of `existing` that are fixed.
  std::span<const model::CellPair> released = {};  ///< Touch without being connected.
  std::int32_t support_z = 0;                      ///< Modules in this layer rest on the ground.
  model::Material material = {};
};

/// Makes a robot without a file. Its modules are the existing ones, then the planned ones, each in
/// the order given. Errors: those of model::Robot::create. 0 threads: as many as there are cores.
base::Result<model::Robot> make_robot(const RobotCells& cells, int thread_count = 0);

/// The options of a check.
struct CheckOptions {
  /// The ground holds like a module below would: supports neither lift nor tilt.
  bool is_bonded = false;
  /// The number of threads, on which the result does not depend; 0: as many as the machine has
  /// cores.
  int thread_count = 0;
  /// The most memory that a check takes; the verdict is `undecided` if it needs more.
  std::size_t memory_bytes_max = solver::EquilibriumOptions{}.memory_bytes_max;
  /// Proves the largest load ratio; a verdict that is not proved becomes `undecided`.
  bool is_proof_wanted = false;
  /// Seeks the buckling factor whatever it is. Otherwise it is sought where it is below 10.
  bool is_buckling_wanted = false;
  /// Seeks the limit load: the largest factor of all loads that any forces could balance.
  bool is_limit_wanted = false;
  /// Follows the equilibria in the deformed shape, up to a factor of all loads of at least 1, and
  /// judges the robot by them. Not together with a proof.
  bool is_deformed_wanted = false;
  double factor_max = large::Options{}.factor_max;
  /// Goes on behind the first loss of stability; that changes no verdict.
  bool is_followed_behind = false;
  /// A function that is called with each equilibrium in the deformed shape; large::Options.
  std::function<void(const large::State& state, bool is_stable, int branch)> on_deformed_state = {};
  /// What modules may meet as the robot bends; check() of a structure takes the file's.
  std::span<const model::Obstacle> obstacles = {};
  double limit_seconds_max = limit::LimitOptions{}.seconds_max;
  /// A function that is called while the limit load is sought, with the bounds that are known.
  std::function<void(double low, double high)> limit_progress = {};
  /// A function that is called while a large robot is solved, with the share of the first error
  /// that is left.
  std::function<void(int iteration, double error)> progress = {};
};

struct CheckResult {
  verdict::Assessment assessment;
  double seconds = 0;  ///< From the robot in memory to the verdict.
  std::optional<proof::Proof> proof = {};
  double proof_seconds = 0;  ///< Beyond `seconds`.
  std::optional<limit::LimitLoad> limit = {};
  double limit_seconds = 0;  ///< Beyond both.
  bool is_deformed = false;  ///< Whether the assessment is that of the deformed shape.
  std::optional<large::Path> deformed = {};  ///< None if the robot topples unbent, or unasked.
  double deformed_seconds = 0;               ///< Beyond all others.
};

/// The library's version, "major.minor.patch".
std::string_view version();

/// Reads a whole file of text, or one of a format with zero bytes, such as a binary structure; "-"
/// is standard input. Errors: a folder, too large, not readable, a zero byte in a text, at which
/// reading ends.
base::Result<std::string> read_file(const std::filesystem::path& path);

/// Writes a whole file or nothing, as host::OutputFile does; "-" is standard output.
std::optional<base::Error> write_file(const std::filesystem::path& path, std::string_view text);

/// Writes what `write` puts into the stream, for files that are too large for a text.
std::optional<base::Error> write_file(const std::filesystem::path& path,
                                      const std::function<void(std::ostream&)>& write);

/// Reads a structure from a file, in any format that io::read_document() reads; the ending of the
/// file's name counts where the options have none.
base::Result<io::ReadDocument> read_structure(const std::filesystem::path& path,
                                              const io::ReadOptions& options = {});

/// Reads a structure in any format that io::read_document() reads and builds the robot with the
/// first planned step. 0 threads: all cores. The options say what a file leaves open.
base::Result<Structure> load_text(std::string_view text, std::string_view name = {},
                                  int thread_count = 0, const io::ReadOptions& options = {});
base::Result<Structure> load_file(const std::filesystem::path& path, int thread_count = 0,
                                  const io::ReadOptions& options = {});

/// Builds the robot of a document with its first planned step, as load_text() does of what it has
/// read. `name` is for a document without one. Errors: those of io::make_robot.
base::Result<Structure> make_structure(io::Document document, std::string_view name = {},
                                       int thread_count = 0);

/// One of the structures of model::families(), to begin with or to compare solvers in: arm, arch,
/// crane, stairs and more. Errors: no such family, a size that is not allowed.
base::Result<io::Document> generate(std::string_view family, std::size_t size);

/// The name of each family and the meaning of its size, in the order of their list.
std::vector<std::pair<std::string_view, std::string_view>> family_list();

/// Checks a robot. One that is in several pieces must not be asked for a proof, the limit load or
/// the deformed shape.
CheckResult check(const model::Robot& robot, const CheckOptions& options = {});

/// Checks the structure's robot.
CheckResult check(const Structure& structure, const CheckOptions& options = {});

/// Checks many robots, in their order, several at a time, each as check() does on one thread. A few
/// are checked one after the other on all threads. `progress` is called from this thread, now and
/// then and at the end, with how many are done.
std::vector<CheckResult> check_many(std::span<const model::Robot* const> robots,
                                    const CheckOptions& options = {},
                                    const std::function<void(std::size_t done)>& progress = {});

/// Numbers in rows of `width`, one row behind the other without gaps: a view of what is owned by
/// the result that it was taken of.
struct Rows {
  std::span<const double> numbers;
  std::size_t width = 0;

  std::size_t count() const { return numbers.size() / width; }

  std::span<const double> row(std::size_t index) const {
    return numbers.subspan(index * width, width);
  }
};

/// The loads of every connection, in the order of Robot::connections(), as the members of
/// verdict::ConnectionResult: load ratio, axial force (N), bending moment (N mm), shear force (N),
/// torsional moment (N mm). No rows where no equilibrium is known.
Rows connection_rows(const CheckResult& result);

/// The limit that each connection's load ratio refers to, in the order of Robot::connections().
/// Empty where no equilibrium is known.
std::vector<model::Limit> connection_limits(const model::Robot& robot,
                                            const verdict::Assessment& assessment);

/// The displacement of every module, in the order of Robot::modules(): along x, y, z in mm, about
/// x, y, z in rad. No rows where no equilibrium is known.
Rows displacement_rows(const CheckResult& result);

/// The force of the ground on every module, in the order of Robot::modules(): force in N, moment
/// about the module's centre in N mm, made of what its facets carry. Empty where no equilibrium is
/// known.
std::vector<base::Vec6<double>> ground_forces(const model::Robot& robot, const CheckResult& result);

/// The certificate of a check's proof, for holdfast-checker; see docs/formats.md. Errors: there is
/// none, as nothing could be proved, or no proof was wanted.
base::Result<std::string> certificate_text(const Structure& structure, const CheckResult& result);

struct TextOptions {
  bool has_notes = true;  ///< Whether it lists those of the reader.
};

/// Reports and pictures of a checked structure; see io/report.hpp and io/picture.hpp, and for other
/// formats check_formats.hpp. The text is what the program prints below the line of the verdict.
std::string report_json(const Structure& structure, const CheckResult& result);
std::string report_text(const Structure& structure, const CheckResult& result,
                        const TextOptions& options = {});
std::string picture_svg(const Structure& structure, const CheckResult& result,
                        const io::FigureOptions& figure = {});

/// Writes the JSON report into a stream, in a fixed amount of memory, however large the robot;
/// `more` adds keys at its end.
void write_report_json(std::ostream& out, const Structure& structure, const CheckResult& result,
                       const io::ReportOptions& options = {}, const io::MoreKeys& more = {});

/// The entry of a JSON report for a file that could not be checked: {"name", "error", "where"}.
std::string error_json(const base::Error& error, const io::ReportOrigin& origin);

/// One line for people: "FILE: line 12: message".
std::string describe(const base::Error& error, std::string_view file);

}  // namespace holdfast
