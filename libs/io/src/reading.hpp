// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/io/document.hpp"
#include "holdfast/io/near_miss.hpp"
#include "numbers.hpp"

namespace holdfast::io {

/// More attributes of one element, or members of one object, are refused; looking for double ones
/// takes quadratic time.
inline constexpr std::size_t kAttributeCountMax = 256;

/// Elements of the scenery stand in one another at most so deep: both formats can hold them.
inline constexpr int kSceneryNestingMax = 16;

/// More different warnings are counted only.
inline constexpr std::size_t kWarningCountMax = 100;

inline constexpr IntegerRange kCoordinateRange = {-base::kCoordinateMax, base::kCoordinateMax};
inline constexpr IntegerRange kColorRange = {0, 255};
inline constexpr IntegerRange kGridRange = {1, base::kCoordinateMax + 1};

/// The value of an attribute; nullptr if there is none of this name.
const std::string* find_attribute(const Attributes& attributes, std::string_view name);

/// Collects what a reader has found so far. Only the first failure counts: a reader may go on with
/// any value and has to look at has_failed() only before it does much more.
class Reading {
 public:
  /// Gives the place of a warning; called only for the first of equal warnings.
  using Where = std::function<std::string()>;

  Document document;
  bool allows_unknown = false;  ///< ReadOptions::allow_unknown.

  void fail(base::Error error);

  bool has_failed() const { return error_.has_value(); }

  void warn(std::string message, const Where& where);

  /// Warns of something that has a name and is not known, such as "the key 'x'", and says what
  /// becomes of it; a failure if the name looks like a known one.
  void note_unknown(const std::string& what, std::string_view name, Names known,
                    std::string_view fate, const Where& where);

  /// Counts cells that are about to be read; false, and a failure, if they become too many.
  bool take_room(std::size_t cell_count, const Where& where);

  /// The colour of an XML element. A colour decides nothing, so one that cannot be is noted and not
  /// refused: VisibleSim exports fractions, of which it takes the whole part itself.
  std::optional<Color> take_color(std::string_view element, std::string_view text,
                                  const Where& where);

  /// Keeps it if its verdict is one.
  void take_known_answer(KnownAnswer answer, const Where& where);

  /// The robot of the catalogue that the document names, or else the options: its figures become
  /// the material and the lattice; a failure if these differ, or if there is no robot of that name.
  /// Before anything of the material, and take_lattice().
  void take_robot(const std::string& named, const ReadOptions& options, const Where& where);

  /// Takes the settings of the options, then fails if the material lacks a figure that is not
  /// published for the robot, else fills in the section; to be called when the whole material is
  /// read.
  void complete_material(const ReadOptions& options, const Where& where);

  /// The lattice of the document: `named`, what the file says, or what the options say; a failure
  /// if these differ, or if there is no lattice of that name. False if neither says anything.
  bool take_lattice(std::optional<std::string_view> named, const ReadOptions& options,
                    const Where& where);

  /// Keeps <obstacleList>: obstacles that touch modules, their colours, what else there is.
  void take_obstacles(const Element& list, const Where& where);

  /// Looks for gridSize in document.world.
  void read_grid(const Where& where);

  /// A cell as it stands in the file, where the grid counts.
  base::Cell in_file(const base::Cell& cell) const {
    return {cell.x + shift_.x, cell.y + shift_.y, cell.z + shift_.z};
  }

  /// Cells per axis, after read_grid.
  const std::optional<base::Cell>& grid() const { return grid_; }

  /// The document with its warnings, or the failure. Warns of what mechanics do not know.
  base::Result<ReadDocument> finish() &&;

 protected:
  /// The offset from a cell of the document to the same cell in the file and its grid.
  base::Cell shift_;

 private:
  struct Warning {
    std::string message;
    std::string where;
    std::size_t count = 1;
  };

  void warn_of_content();
  void warn_of_attributes();
  void warn_of_targets();
  std::vector<std::string> warning_texts() const;

  std::optional<base::Error> error_;
  std::vector<Warning> warnings_;
  std::size_t warnings_left_out_ = 0;
  std::size_t cell_count_ = 0;
  std::optional<base::Cell> grid_;
};

}  // namespace holdfast::io
