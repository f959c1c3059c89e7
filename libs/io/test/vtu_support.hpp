// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#ifndef __EMSCRIPTEN__
#include <zlib.h>
#endif

#include <array>
#include <cstring>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "picture_support.hpp"

/// A .vtu file read back.
namespace holdfast::io::picture_test {

/// A little-endian number at a place of a text.
template <class Number>
Number number_at(std::string_view bytes, std::size_t place) {
  Number number{};
  std::memcpy(&number, bytes.substr(place).data(), sizeof number);
  return number;
}

/// The bytes of one array of the appended data, which begins at `data`, by VTK's description of it:
/// counts of 64 bits (blocks, their size, that of the last one or 0, compressed sizes), then blocks
/// in zlib's format; without a compressor the size and the bytes.
inline std::string array_bytes(std::string_view data, bool is_compressed) {
  const auto count = [&](std::size_t i) { return number_at<std::uint64_t>(data, 8 * i); };
  if (!is_compressed) {
    return std::string(data.substr(8, count(0)));
  }
  std::string all;
#ifndef __EMSCRIPTEN__
  std::string_view blocks = data.substr(8 * (3 + count(0)));
  for (std::size_t i = 0; i < count(0); ++i) {
    const bool is_part = i + 1 == count(0) && count(2) > 0;
    std::string block(is_part ? count(2) : count(1), '\0');
    uLongf size = block.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(block.data()), &size,
                         reinterpret_cast<const Bytef*>(blocks.data()), count(3 + i)),
              Z_OK);
    EXPECT_EQ(size, block.size());
    all += block;
    blocks.remove_prefix(count(3 + i));
  }
#endif
  return all;
}

template <class Number>
void append_numbers(std::string_view bytes, std::vector<double>& values) {
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(Number)) {
    values.push_back(static_cast<double>(number_at<Number>(bytes, i)));
  }
}

inline std::string text_of(const model::Robot& robot, const verdict::Assessment& assessment,
                           const WriteOptions& options = {}) {
  std::ostringstream out;
  write_vtu(out, robot, assessment, options);
  return out.str();
}

/// A file read by hand, with a decompressor that is not the writer's.
class Grid {
 public:
  Grid(const model::Robot& robot, const verdict::Assessment& assessment)
      : Grid(text_of(robot, assessment)) {}

  explicit Grid(std::string text) : text_(std::move(text)) {
    constexpr std::string_view kBegin = "<AppendedData encoding=\"raw\">\n_";
    constexpr std::string_view kEnd = "\n</AppendedData>\n</VTKFile>\n";
    const std::size_t begin = text_.find(kBegin);
    EXPECT_TRUE(begin != std::string::npos && text_.ends_with(kEnd));
    data_at_ = begin + kBegin.size();
    const std::string head = text_.substr(0, begin) + "</VTKFile>";
    const auto result = document_.load_string(head.c_str());
    EXPECT_TRUE(result) << result.description();
    const pugi::xml_node file = document_.child("VTKFile");
    EXPECT_EQ(file.attribute("header_type").value(), std::string_view("UInt64"));
    compressor_ = file.attribute("compressor").value();
    EXPECT_EQ(compressor_, kCompressor);
    grid_ = file.child("UnstructuredGrid");
  }

  std::size_t point_count() const {
    return grid_.child("Piece").attribute("NumberOfPoints").as_ullong();
  }

  std::size_t cell_count() const {
    return grid_.child("Piece").attribute("NumberOfCells").as_ullong();
  }

  /// All numbers of an array anywhere in the file.
  std::vector<double> numbers(const std::string& name) const {
    const pugi::xml_node array =
        document_.select_node(fmt::format("//*[@Name='{}']", name).c_str()).node();
    EXPECT_TRUE(array) << name;
    const bool is_appended = array.attribute("format").value() == std::string_view("appended");
    return is_appended ? appended_numbers(array) : listed_numbers(array);
  }

  std::array<double, 3> triple(const std::string& name, std::size_t index) const {
    const auto all = numbers(name);
    return {all.at(3 * index), all.at(3 * index + 1), all.at(3 * index + 2)};
  }

  std::string verdict() const {
    std::string word;
    for (const double code : numbers("verdict")) {
      word += code == 0 ? '\0' : static_cast<char>(code);
    }
    return word;
  }

  const pugi::xml_node& grid() const { return grid_; }

 private:
#ifdef __EMSCRIPTEN__
  static constexpr std::string_view kCompressor;
#else
  static constexpr std::string_view kCompressor = "vtkZLibDataCompressor";
#endif

  static std::vector<double> listed_numbers(const pugi::xml_node& array) {
    std::istringstream stream(array.child_value());
    std::vector<double> values;
    for (double value = 0; stream >> value;) {
      values.push_back(value);
    }
    EXPECT_TRUE(stream.eof()) << "something is not a number";
    return values;
  }

  std::vector<double> appended_numbers(const pugi::xml_node& array) const {
    const std::size_t offset = array.attribute("offset").as_ullong();
    const std::string bytes =
        array_bytes(std::string_view(text_).substr(data_at_ + offset), !compressor_.empty());
    const std::string_view type = array.attribute("type").value();
    std::vector<double> values;
    if (type == "Float64") {
      append_numbers<double>(bytes, values);
    } else if (type == "Int64") {
      append_numbers<std::int64_t>(bytes, values);
    } else if (type == "Int32") {
      append_numbers<std::int32_t>(bytes, values);
    } else if (type == "Int8") {
      append_numbers<std::int8_t>(bytes, values);
    } else {
      EXPECT_EQ(type, "UInt8");
      append_numbers<std::uint8_t>(bytes, values);
    }
    return values;
  }

  std::string text_;
  std::size_t data_at_ = 0;
  std::string_view compressor_;
  pugi::xml_document document_;
  pugi::xml_node grid_;
};

inline Grid write(const model::RobotSpec& spec) {
  const model::Robot robot = make(spec);
  return {robot, verdict::assess(robot)};
}

}  // namespace holdfast::io::picture_test
