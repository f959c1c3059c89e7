// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/result.hpp"
#include "holdfast/io/element.hpp"
#include "holdfast/io/extension.hpp"
#include "holdfast/model/robot.hpp"

/// A structure as it stands in a file: what mechanics need, and what a conversion must not lose.
namespace holdfast::io {

/// One existing module.
struct ModuleEntry {
  base::Cell cell;
  bool is_fixed = false;
  std::optional<Color> color;
  Attributes attributes;  ///< Everything else: id, centroid, solver, stabilityCheck, master...

  friend bool operator==(const ModuleEntry&, const ModuleEntry&) = default;
};

/// One cell of a planned step.
struct PlannedEntry {
  base::Cell cell;
  std::optional<Color> color;
  Attributes attributes;

  friend bool operator==(const PlannedEntry&, const PlannedEntry&) = default;
};

/// Modules that are to be attached together.
using Step = std::vector<PlannedEntry>;

/// The answer that a shipped scenario is known to have; tests compare it with what we compute.
struct KnownAnswer {
  std::string verdict;  ///< "safe", "overload", "unstable"
  std::optional<double> margin_mm;
  std::optional<double> load_ratio_max;
  std::string source;  ///< Where the answer comes from.

  friend bool operator==(const KnownAnswer&, const KnownAnswer&) = default;
};

enum class Format : std::uint8_t { kVisibleSimXml, kJson, kBinary };

/// The kind of file that a document was read from, in whose words places in it are named. It says
/// nothing of the structure, so any two are equal.
struct Origin {
  Format format = Format::kJson;

  friend bool operator==(const Origin& /*a*/, const Origin& /*b*/) { return true; }
};

struct Document {
  std::string name;         ///< May be empty.
  std::string description;  ///< May be empty.
  std::int32_t support_z = 0;
  model::Material material;
  /// Whether the elastic modulus is said to be what it is by default. Any other is stated anyway.
  bool is_default_modulus_stated = false;
  std::vector<ModuleEntry> modules;
  std::vector<Step> steps;  ///< The first one is the planned step that is checked.
  std::optional<KnownAnswer> known_answer;
  Extension extension;  ///< What only version 2 of the JSON format can say.
  Origin origin;
  /// Whether make_robot() takes modules that are in several pieces, each of which something holds;
  /// no file says it.
  bool may_be_in_pieces = false;
  /// Whether an option says the lattice; then pieces are not taken for a robot of another one, or
  /// of other units.
  bool is_lattice_chosen = false;

  // VisibleSim's own, without meaning for mechanics.
  Attributes parameters;         ///< Of <parameters>: nofIterations, preconditioner, globalBeta...
  Attributes world;              ///< Of <world>: gridSize, windowSize...
  Attributes block_list;         ///< Of <blockList>: blockSize, size, ids...
  std::vector<Element> scenery;  ///< Other children of <world>: camera, spotlight...
  std::vector<Element> targets;  ///< Those of <targetList> that are no grids: csg, surface...

  friend bool operator==(const Document&, const Document&) = default;
};

/// A document and what its reader wants its user to know (kept attributes, later steps...).
struct ReadDocument {
  Document document;
  std::vector<std::string> warnings;
};

/// The limits of what is read, against files that are not what they seem. Nesting is that of XML
/// elements, and of JSON objects and arrays.
inline constexpr std::size_t kFileBytesMax = std::size_t{1} << 30U;
inline constexpr int kNestingMax = 64;

/// The format by its first letters, HOLDFAST for a binary structure, or by the first character that
/// is not white space: '<' for XML, '{' or '[' for JSON; an error for anything else, of which
/// foreign_formats() may still be one.
base::Result<Format> detect_format(std::string_view text);

/// A number of the material that replaces what a file or its robot says.
struct Setting {
  std::string key;  ///< Of model::kMaterialParameters, or of a connector, such as shear_strength_n.
  double value = 0;

  friend bool operator==(const Setting&, const Setting&) = default;
};

/// Reads "strength_lateral_n=12", or the same after "material.". Errors: no such key, with the one
/// that is probably meant; no number, or one that the key does not allow.
base::Result<Setting> find_setting(std::string_view text);

/// The layer whose modules rest on the ground, by its z.
struct SupportLevel {
  std::optional<std::int32_t> z;  ///< None: that of the lowest existing module.

  friend bool operator==(const SupportLevel&, const SupportLevel&) = default;
};

/// Reads "lowest" or the z of a layer. Error: it is neither.
base::Result<SupportLevel> find_support_level(std::string_view text);

/// Says of which kind the modules are that voxels become.
struct VoxelPalette {
  std::vector<KindEntry> kinds;
  /// The name of one of the kinds, by the index of a colour in the palette of the file, 1 to 255.
  std::map<std::int32_t, std::string> kind_of;
};

/// Reads a palette from JSON. Errors: it is none; it names a kind that it does not have.
base::Result<VoxelPalette> read_palette(std::string_view text);

/// The values that hold where a file says nothing, and are an error where it says otherwise; and
/// the limits of what a file may hold.
struct ReadOptions {
  std::optional<base::Lattice> lattice = {};  ///< One of kNamedLattices.
  std::string robot = {};  ///< One of model::robot_catalogue(); empty: Table I of the paper.
  /// Whether a key of holdfast JSON that nobody knows is ignored with a note. If not, it is an
  /// error, as what it says would be lost, but for one that begins with `x-`, which is for others.
  bool allow_unknown = false;
  std::vector<Setting> settings = {};  ///< The last one of a key counts. Warnings name them.
  /// The support level that replaces the file's, with a warning; heeded by read_document().
  std::optional<SupportLevel> support = {};
  /// The ending of the file's name, in small letters with its dot, such as ".csv"; empty where it
  /// is not known. It decides what the first letters of a foreign file leave open.
  std::string ending = {};
  /// The edge of a cell in the unit of a mesh that is filled with modules; a mesh needs it.
  std::optional<double> mesh_pitch = {};
  /// The safety factor that replaces the file's; heeded by read_document(), which warns of any.
  std::optional<double> safety_factor = {};
  bool may_be_in_pieces = false;  ///< Document::may_be_in_pieces; heeded by read_document().
  /// The kinds of voxels; an error with files that have none.
  std::optional<VoxelPalette> palette = {};
};

/// Takes a number of the material that somebody states.
void take_number(const model::MaterialParameter& parameter, double value, Document& document);

/// Whether a writer has to say a number of the material: one that is not among the `defaults`, or
/// the elastic modulus where it is stated.
bool is_said(const model::MaterialParameter& parameter, const model::Material& defaults,
             const Document& document);

/// Reads any of the formats, those of foreign_formats() too. Error::where is "line 12" or a JSON
/// pointer such as "/modules/3".
base::Result<ReadDocument> read_document(std::string_view text, const ReadOptions& options = {});

base::Result<ReadDocument> read_visiblesim(std::string_view text, const ReadOptions& options = {});
base::Result<ReadDocument> read_json(std::string_view text, const ReadOptions& options = {});

/// The version of the JSON format that a document needs, and is written in: 1 wherever that says it
/// all, so that older programs read it.
int json_version(const Document& document);

/// The offset that write_visiblesim adds to every cell and to support_z: VisibleSim knows no cell
/// below 0. The attribute `shift` of <holdfast> says it, and the reader takes it back. Positions in
/// scenery, targets and attributes stay as they are. Layers go up by an even number where they are
/// staggered. Error: the cells reach further than its grid can.
base::Result<base::Cell> visiblesim_shift(const Document& document);

/// Boxes of obstacles with more cells than this are one <obstacle> in VisibleSim XML, that of their
/// first corner, with the other corner in an attribute of ours; all others are one for each cell.
inline constexpr std::int64_t kBoxCellsMax = 10'000;
bool is_large_box(const model::Obstacle& obstacle);

/// Writes a document; reading it back gives an equal one. Comments and the layout of the text are
/// not kept, and blocksLine and blockBox are written as single blocks. Where visiblesim_shift is an
/// error, cells are written as they are.
std::string write_visiblesim(const Document& document);
std::string write_json(const Document& document);

/// Figures that a robot may have but hardly does, with what was probably meant: a density of
/// modules, a modulus or a pitch in another unit, facets wider than the pitch, all modules of a
/// shape that stands in the layer on the floor. Readers give them as warnings.
std::vector<std::string> doubtful_figures(const Document& document);

/// Makes the specification of the robot of the document with the first step, without its plan.
/// Errors: a number that is not allowed; a module is of a kind that the document does not have.
base::Result<model::RobotSpec> make_spec(const Document& document);

/// A robot and what happens to it.
struct Sequence {
  model::RobotSpec start;  ///< The existing modules.
  /// The steps of the document from first_step() on, each as a step that attaches its modules, then
  /// the plan. A load on a cell where no module is at first belongs to the first step that attaches
  /// one there.
  std::vector<model::Step> steps;
};

/// The document whose strengths are those that its safety factor leaves, which is then 1: limits of
/// connections by tension, shear and torsion, of the material, the robot, kinds and connections.
Document with_allowed_strengths(Document document);

/// Returns the index in Document::steps of the first step of make_sequence(): 1 where nothing is
/// planned.
std::size_t first_step(const Document& document);

/// The number of steps of make_sequence().
std::size_t step_count(const Document& document);

/// Returns the place in the file of a step of make_sequence(), by its number: a JSON pointer, or
/// the element of VisibleSim XML.
std::string step_pointer(const Document& document, std::size_t step);

/// Returns the place where the file lists steps beyond the first, or would list them.
std::string step_list(const Document& document);

/// Makes the sequence of a document. Errors: those of make_spec().
base::Result<Sequence> make_sequence(const Document& document);

/// The error of a robot that could not be made of the document, with the lattice in which its
/// modules are connected where they are not in the one taken, and with the layer on which they
/// could stand where nothing holds them: files for VisibleSim say neither.
base::Error with_other_lattice(base::Error error, const Document& document);

/// Makes the robot with the first step; threads are those of model::Robot::create. Errors: those of
/// make_spec(), and those of model::Robot::create with_other_lattice(). Pieces of a robot that
/// another lattice would connect, or other units, are an error too, unless an option says which
/// lattice it is.
base::Result<model::Robot> make_robot(const Document& document, int thread_count = 0);

}  // namespace holdfast::io
