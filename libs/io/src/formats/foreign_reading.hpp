// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/io/foreign_format.hpp"
#include "reading.hpp"

/// Importers: one small file for each foreign format, all behind the type Importer.
namespace holdfast::io {

/// Collects the cells of a foreign file.
class ForeignReading : public Reading {
 public:
  /// The text and the options must outlive the reading.
  ForeignReading(std::string_view file_text, const ReadOptions& read_options)
      : text(file_text), options(read_options) {}

  using Reading::fail;

  std::string_view text;  ///< The whole file.
  const ReadOptions& options;

  /// Fails with the number of a line, which counts from 1.
  void fail_at(std::size_t line, std::string message);

  /// Warns of the whole file.
  void warn_of_all(std::string message);

  /// Adds a module; a failure if the cell is out of range, or if there are too many.
  void add(double x, double y, double z, std::optional<Color> color = std::nullopt,
           bool is_fixed = false);

  std::size_t line = 0;  ///< Of the module that is added; 0 where there are no lines.
};

/// A format and how it is read.
struct Importer {
  ForeignFormat format;
  /// Whether a text is in this format; `ending` is that of the file, or empty.
  bool (*is_one)(std::string_view text, std::string_view ending);
  void (*read)(ForeignReading& reading);
};

/// The lines of a text with their numbers, one after the other, without blanks at their ends.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  /// The next line that is not empty; none at the end.
  std::optional<std::string_view> next();

  std::size_t number() const { return number_; }  ///< Of the line that next() returned; from 1.

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// The most columns that split_row() returns; no line that is read has so many.
inline constexpr std::size_t kColumnCountMax = 1000;

/// The parts of a line between blanks, or commas and semicolons with blanks around them.
std::vector<std::string_view> split_row(std::string_view line);

bool is_cell_list(std::string_view text, std::string_view ending);
void read_cell_list(ForeignReading& reading);

bool is_json_list(std::string_view text, std::string_view ending);
bool is_pathfinder(std::string_view text, std::string_view ending);
bool is_squares(std::string_view text, std::string_view ending);
bool is_rofi_voxels(std::string_view text, std::string_view ending);
bool is_stable_lego(std::string_view text, std::string_view ending);
/// Reads any of these five.
void read_json_cells(ForeignReading& reading);

bool is_vox(std::string_view text, std::string_view ending);
void read_vox(ForeignReading& reading);

bool is_stl(std::string_view text, std::string_view ending);
void read_stl(ForeignReading& reading);

bool is_obj(std::string_view text, std::string_view ending);
void read_obj(ForeignReading& reading);

bool is_brick_text(std::string_view text, std::string_view ending);
void read_brick_text(ForeignReading& reading);

bool is_ldraw(std::string_view text, std::string_view ending);
void read_ldraw(ForeignReading& reading);

bool is_scenario(std::string_view text, std::string_view ending);
void read_scenario(ForeignReading& reading);

bool is_record(std::string_view text, std::string_view ending);
void read_record(ForeignReading& reading);

bool is_rofi_world(std::string_view text, std::string_view ending);
/// Says why there are no cells in it.
void refuse_rofi_world(ForeignReading& reading);

}  // namespace holdfast::io
