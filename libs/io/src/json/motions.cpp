// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <iterator>
#include <utility>
#include <vector>

#include "holdfast/io/lattice_names.hpp"
#include "holdfast/io/move_report.hpp"
#include "json/json_connectors.hpp"
#include "json/json_values.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kMotionsFormat = "holdfast-motions";
constexpr auto kFileKeys = std::to_array<std::string_view>(
    {"format", "version", "name", "lattice", "between_opposing", "images", "motions"});
constexpr auto kMotionKeys =
    std::to_array<std::string_view>({"name", "to", "modules", "free", "images"});
/// The names of plan::MotionImages.
constexpr auto kImages = std::to_array<std::string_view>({"none", "turned", "mirrored"});

plan::MotionImages read_images(JsonReading& reading, const Json& value, const JsonPlace& here) {
  return static_cast<plan::MotionImages>(read_choice(reading, value, here, kImages));
}

/// Reads motions of one lattice.
class MotionReader {
 public:
  MotionReader(JsonReading& reading, const base::Lattice& lattice, plan::MotionImages images)
      : reading_(reading), lattice_(lattice), images_(images) {}

  std::vector<plan::Motion> read(const Json& value, const JsonPlace& place) {
    plan::Motion motion;
    plan::MotionImages images = images_;
    for (const auto& [key, member] : reading_.members(value, place)) {
      const JsonPlace here = place.at(key);
      if (key == "name") {
        motion.name = reading_.string(member, here);
      } else if (key == "to") {
        motion.to = axial(member, here);
      } else if (key == "modules" || key == "free") {
        (key == "modules" ? motion.modules : motion.free) = cells(member, here);
      } else if (key == "images") {
        images = read_images(reading_, member, here);
      } else {
        reading_.note_unknown_key(here, kMotionKeys);
      }
    }
    if (!reading_.has_failed() && !value.contains("to")) {
      reading_.fail_missing(value, place, "to");
    }
    if (reading_.has_failed()) {
      return {};
    }
    auto valid = plan::valid_motion(lattice_, std::move(motion));
    if (!valid) {
      reading_.fail(place, valid.error().message);
      return {};
    }
    return plan::images_of(lattice_, valid.value(), images);
  }

 private:
  base::Cell axial(const Json& value, const JsonPlace& here) {
    return base::axial_of(lattice_, reading_.cell(value, here));
  }

  std::vector<base::Cell> cells(const Json& value, const JsonPlace& here) {
    std::vector<base::Cell> found;
    const Json::array_t& list = reading_.elements(value, here, "an array of cells");
    for (std::size_t i = 0; i < list.size(); ++i) {
      found.push_back(axial(list[i], here.at(i)));
    }
    return found;
  }

  JsonReading& reading_;
  const base::Lattice& lattice_;
  plan::MotionImages images_;
};

base::Lattice read_lattice_name(JsonReading& reading, const Json& value, const JsonPlace& here) {
  const auto lattice = find_lattice(reading.string(value, here));
  if (!lattice) {
    reading.fail(here, lattice.error().message);
  }
  return lattice ? lattice.value() : base::kCubic;
}

/// Reads everything but the motions, which are in the lattice that is read here; returns the images
/// of motions that do not say.
plan::MotionImages read_frame(JsonReading& reading, const Json& root, const JsonPlace& top,
                              plan::Motions& found) {
  plan::MotionImages images = plan::MotionImages::kTurned;
  for (const auto& [key, value] : reading.members(root, top)) {
    const JsonPlace here = top.at(key);
    if (key == "name") {
      found.name = reading.string(value, here);
    } else if (key == "lattice") {
      found.lattice = read_lattice_name(reading, value, here);
    } else if (key == "between_opposing") {
      found.goes_between = reading.boolean(value, here);
    } else if (key == "images") {
      images = read_images(reading, value, here);
    } else if (std::ranges::find(kFileKeys, key) == kFileKeys.end() && key != "$schema") {
      reading.note_unknown_key(here, kFileKeys);
    }
  }
  return images;
}

}  // namespace

base::Result<plan::Motions> read_motions(std::string_view text) {
  const auto root = parse_json(text);
  if (!root) {
    return root.error();
  }
  JsonReading reading;
  const JsonPlace top;
  expect_format(reading, root.value(), top, kMotionsFormat);
  plan::Motions found;
  const plan::MotionImages images = read_frame(reading, root.value(), top, found);
  const bool has_motions = root.value().is_object() && root.value().contains("motions");
  if (!reading.has_failed() && has_motions) {
    const JsonPlace place = top.at("motions");
    const Json::array_t& list = reading.elements(root.value().at("motions"), place);
    MotionReader reader(reading, found.lattice, images);
    for (std::size_t i = 0; i < list.size() && !reading.has_failed(); ++i) {
      std::ranges::move(reader.read(list[i], place.at(i)), std::back_inserter(found.motions));
    }
  }
  if (!reading.has_failed() && found.motions.empty() && (has_motions || found.goes_between)) {
    reading.fail(top.at("motions"),
                 "expected at least one motion; only with \"between_opposing\": false may there "
                 "be none, for those of the lattice");
  }
  auto finished = std::move(reading).finish();
  return finished ? base::Result<plan::Motions>(std::move(found)) : finished.error();
}

}  // namespace holdfast::io
