// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "holdfast/agent/wire/wire.hpp"
#include "holdfast/base/cell.hpp"

/// Golden text of the wire format, written by hand from docs/wire.md; docs/evidence/wire.md
/// shows the same lines.
namespace holdfast::agent::test {

/// Orders by operation: 1 to 5, 12 to 31.
inline constexpr std::array<std::string_view, 26> kGoldenOrders = {
    "05 01 02 01 00 00 fe ff ff 03 00 00",
    "05 02 01 00 02 00 04 00 08 00 10 00 20 00 00 00 00 00",
    "05 03 c0 bd f0 40 42 0f 00 00 00",
    "05 04 05 1d 00 00 00 fd ff ff ff ff ff ff ff 05 00 00 00 00 00 00 00",
    "05 05 03 09 00 00 00 00 3f 00 00 7a 44",
    "05 0c 02",
    "05 0d",
    "05 0e",
    "05 0f 02 02 00 00 c0 3f 01 00 00 fe ff ff 03 00 00 05",
    "05 10",
    "05 11 03 2c 01 00 00 80 3e 00 00 00 bf 00 00 80 be",
    "05 12",
    "05 13 06 03 00 00 00 00 3f 00 00 7a 44",
    "05 14 01 01 00 00 fe ff ff 03 00 00",
    "05 15 47 01 00 00 fe ff ff 03 00 00",
    "05 16 5a 02 00 00 00 00 00 3f 00 00 7a 44 1d 00 00 00 fd ff ff ff 05 00 00 00 01 02 04 08 10",
    "05 17",
    "05 18 01 04 00 01 00 00 fe ff ff 03 00 00 4a 41 01 00",
    "05 19 03 02 00 00 02 02 00 00 c0 3f 01 00 00 fe ff ff 03 00 00 05",
    "05 1a",
    "05 1b 03 01 00 00 fe ff ff 03 00 00 04 00 00 05 00 00 06 00 00 02 00 00 00 80 3e "
    "00 00 00 3f 00 00 00 40",
    "05 1c 00 ef cd ab 89",
    "05 1d 1e 04 2c 01 00 00 00 3f 00 00 7a 44 1d 00 00 00 fd ff ff ff 05 00 00 00 01 02 04 08 10",
    "05 1e 14 2c 01 00 00 80 3e 00 00 00 bf 00 00 80 be 00 00 80 3f 00 00 00 c0 00 00 00 3f "
    "00 00 c0 3f",
    "05 1f 01 07 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 80 3e 00 00 80 bf 00 00 00 00 "
    "00 00 40 40",
    "05 20"};

inline std::string_view golden_order(wire::Operation operation) {
  return *std::ranges::find_if(kGoldenOrders, [&](std::string_view text) {
    const int high = static_cast<int>(std::string_view("0123456789abcdef").find(text[3]));
    const int low = static_cast<int>(std::string_view("0123456789abcdef").find(text[4]));
    return 16 * high + low == static_cast<int>(operation);
  });
}

inline constexpr std::array<std::string_view, 26> kGoldenReports = {
    "06 01 21 00 01 01 00 00 fe ff ff 03 00 00",
    "06 02 87",
    "06 03 1d 00 00 00 3a 00 00 00 fd ff ff ff ff ff ff ff 05 00 00 00 00 00 00 00 07 00 00 00 00 "
    "00 00 00 01 2c 01",
    "06 04 01 01 00 00 00 ff ff ff ff 01 ff ff ff 03 00 00 00",
    "06 05",
    "06 0c 02 00 00 00 01 00 00 00",
    "06 0d 02 01 00 00 ff ff ff 00 00 00 fd ff ff 01 00 00 00 00 00",
    "06 0e 00 00 c0 3f 01 00 00 fe ff ff 03 00 00 04 01 00 00 00 1d 00 00 00",
    "06 0f 1d 00 00 00",
    "06 10",
    "06 11 00 00 80 3e 00 00 00 3f 03 00 ef cd ab 89 01 00 00 80 3f 00 00 80 30 00 00 80 be "
    "00 00 00 00 00 00 40 40 00 00 00 00",
    "06 12 00 00 80 3e 00 00 00 3f 03 00 ef cd ab 89 01",
    "06 13 1d 00 00 00 02 00 00 00",
    "06 14 00 00 04 01 00 00 fe ff ff 03 00 00",
    "06 15 21 00 09 2c 01 1d 00 00 00 3a 00 00 00 fd ff ff ff ff ff ff ff 05 00 00 00 00 00 00 00 "
    "01 00 00 fe ff ff 03 00 00",
    "06 16 87 01 01 00 00 00 ff ff ff ff 01 ff ff ff 03 00 00 00",
    "06 17 02 01 00 00 ff ff ff 00 00 00 fd ff ff 01 00 00 00 00 00 00 00 c0 3f 01 00 00 fe ff ff "
    "03 00 00 04",
    "06 18 01 00 02 00 00 00 04 00 4a 41 01 00 01 00 00 fe ff ff 03 00 00",
    "06 19 01 1d 00 00 00",
    "06 1a 01 00 00 fe ff ff 03 00 00 04 00 00 05 00 00 06 00 00 02 00 00 00 05 00 00 00 00 00 00 "
    "00 00 00 c0 3f 00 00 00 40 03",
    "06 1b 1d 00 00 00 02 00 00 00",
    "06 1c 02 00 00 00 ef cd ab 89",
    "06 1d 87 01 01 00 00 00 ff ff ff ff 01 ff ff ff 03 00 00 00 00 00 80 3f 00 00 00 c0 "
    "00 00 00 3f 00 00 80 3e 00 00 80 3f 00 00 00 3f 00 00 00 40 00 00 80 be 00 00 00 00 "
    "00 00 40 40 00 00 c0 3f 00 00 80 bf 00 00 80 3e 00 00 80 40",
    "06 1e 00 00 80 3e 00 00 00 3f 03 00 ef cd ab 89 01 00 00 80 3f 00 00 80 30 00 00 80 be "
    "00 00 00 00 00 00 40 40 00 00 00 00 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e",
    "06 1f 00 00 80 3e 00 00 c0 3f 00 00 ef cd ab 89 08 00 00 80 3f 00 00 80 30 00 00 80 be "
    "00 00 00 00 00 00 40 40 00 00 00 00 00 00 c0 3f 00 00 80 bf 00 00 00 00 00 00 00 40 "
    "02 01 00 00 ff ff ff 00 00 00 fd ff ff 01 00 00 00 00 00 01 00 00 fe ff ff 03 00 00 94",
    "06 20 03 1d 00 00 00 3c 00 00 00 00 00 c0 3f 00 00 00 3f 00 00 80 3e 00 00 00 40 "
    "00 00 80 3f"};

/// Types 7, 8, 9, 11 to 15 and 20, label 5, with the reals 1, -2, 0.5, 0.25, -1, 1.5.
inline constexpr std::array<std::string_view, 9> kGoldenVectors = {
    "07 05 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f",
    "08 05 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f",
    "09 05 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f",
    "0b 05 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f",
    "0c 05 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f",
    "0d 05 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f",
    "0e 05 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f",
    "0f 05 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f",
    "14 05 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f"};

/// Types 18 and 19: part 5, in which every eighth cell is occupied, and four more at the end.
inline constexpr std::array<std::string_view, 2> kGoldenParts = {
    "12 05 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 f1",
    "13 05 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 01 f1"};

inline constexpr std::string_view kGoldenHello = "c0 40 34 12 00 00 00 00 77 8e";
inline constexpr std::string_view kGoldenHelloHeard = "c0 40 ef be 34 12 00 04 b1 c3";
inline constexpr std::string_view kGoldenHelloOpen = "c0 40 34 12 ef be 01 00 bc 08";
inline constexpr std::string_view kGoldenData = "00 40 04 02 01 05 0d 3a 9b";
inline constexpr std::string_view kGoldenAcknowledge = "40 41 4a 72";
inline constexpr std::string_view kGoldenPing = "80 41 1e 64";

/// What one module says through one face, from the beginning.
struct GoldenStream {
  std::size_t from = 0;
  base::Direction face = base::Direction::kPlusX;
  std::vector<std::string_view> messages;
};

/// Module 0, id 10, the anchor, at (-1, 2, 0); 1, id 11, at (0, 2, 0); 2, id 12, at (0, 3, 0).
inline const std::vector<GoldenStream> kGoldenTrace = {
    {0,
     base::Direction::kPlusX,
     {"01 01 00 0a 00 00 00 01 ff ff ff 02 00 00 00 00 00 00 00",  // join: I start, wave 1
      "03 01 0c 00 00 00 01 00",                                   // appoint 12, half way is 1
      "02 01 00 0a 00 00 00 02 01 00 00 00 02 00 0a 00 00 00 00",  // echo, wave 2
      "04 00 00 ff ff ff 02 00 00 00 00 00",                       // mark: you are half way
      "02 01 00 0a 00 00 00 03 01 00 00 00 01 00 0a 00 00 00 00",  // echo, wave 3
      "06 01 00 00 00 00 00 00 00 00 00 00 00 00",                 // I have announced nothing
      "06 01 08 00 00 00 00 00 00 00 00 00 00 00",                 // it is at my face +y
      "06 02 80",                                                  // hosted elsewhere
      "06 03 01 00 00 00 01 00 00 00 ff ff ff ff ff ff ff ff 00 00 00 00 00 00 00 00 00 00 00 00 "
      "00 00 00 00 00 01 00",                                      // one module at (-1, 0)
      "06 04 01 fb ff ff ff 01 00 00 00 fd ff ff ff ff ff ff ff",  // its corner is below the centre
      "06 05"}},
    {1,
     base::Direction::kMinusX,
     {"02 01 00 0a 00 00 00 01 02 00 00 00 02 00 0c 00 00 00 00",  // echo: two, 12 is furthest
      "01 01 00 0a 00 00 00 02 00 00 00 03 00 00 00 00 00 01 00",  // join, wave 2
      "03 02 0a 00 00 00 01 00",                                   // appoint 10
      "01 01 00 0a 00 00 00 03 00 00 00 02 00 00 00 00 00 00 00",  // join, wave 3: I am the root
      "05 01 ff 00 00 00 00 00 00 00 00 00",                       // what is planned?
      "05 01 00 ff ff ff 03 00 00 00 00 00",                       // planned 0 is at (-1, 3, 0)
      "05 02 09 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00",     // it touches by -y and +x
      "05 03 00 00 00 02 00 00 00 00 00",                          // count, from (0, 2, 0)
      "05 04 05 04 00 00 00 fe ff ff ff ff ff ff ff 02 00 00 00 00 00 00 00",  // four units
      "05 05 06 00 00 17 b7 d1 38 00 00 f0 42",              // iterations, gamma 1e-4, lever 120 mm
      "05 11 05 02 00 00 00 00 00 00 00 00 00 00 00 00 00",  // from rest, degree 2, states stay
      "07 01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00"}},
    {1,
     base::Direction::kPlusY,
     {"01 01 00 0a 00 00 00 01 00 00 00 02 00 00 00 00 00 01 00",    // join, wave 1
      "03 01 0c 00 00 00 01 00",                                     // appoint 12
      "02 01 00 0a 00 00 00 02 02 00 00 00 02 00 0a 00 00 00 00"}},  // echo, wave 2
    {2,
     base::Direction::kMinusY,
     {"02 01 00 0a 00 00 00 01 01 00 00 00 02 00 0c 00 00 00 00",  // echo, wave 1
      "01 01 00 0a 00 00 00 02 00 00 00 03 00 00 00 00 00 00 00",  // join: I start wave 2
      "03 02 0a 00 00 00 01 00",                                   // appoint 10
      "02 01 00 0a 00 00 00 03 01 00 00 00 01 00 0c 00 00 00 00",  // echo, wave 3
      "06 01 00 00 01 ff ff ff 03 00 00 00 00 00",                 // the first is at (-1, 3, 0)
      "06 01 01 00 00 00 00 00 00 00 00 00 00 00"}},               // it is at my face -x
};

/// Round 5 of module 10, sender (1, -2, 3), root (-1000000, 1000000, 0), 7 hops, 258, ratio 1.5.
inline constexpr std::string_view kGoldenAdoption =
    "10 05 00 0a 00 00 00 01 00 00 fe ff ff 03 00 00 c0 bd f0 40 42 0f 00 00 00 07 00 02 01 00 00 "
    "00 00 c0 3f";

/// A plan is fulfilled 7 hops away, at (1, -2, 3).
inline constexpr std::string_view kGoldenNews = "11 07 07 00 01 00 00 fe ff ff 03 00 00";

/// The cut that opens a loop: from (1, -2, 3) to +y.
inline constexpr std::string_view kGoldenLoop = "0a 01 00 00 fe ff ff 03 00 00 02";

}  // namespace holdfast::agent::test
