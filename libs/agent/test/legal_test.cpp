// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What docs/wire.md allows, and that anything else is refused; the golden messages are allowed.
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>

#include "golden.hpp"
#include "holdfast/agent/messages/messages.hpp"
#include "test_setup.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;

TEST(Legal, all_golden_messages_are) {
  for (const auto& texts : {kGoldenOrders, kGoldenReports}) {
    for (const std::string_view text : texts) {
      EXPECT_TRUE(is_legal(from_hex(text))) << text;
    }
  }
  for (const GoldenStream& stream : kGoldenTrace) {
    for (const std::string_view text : stream.messages) {
      EXPECT_TRUE(is_legal(from_hex(text))) << text;
    }
  }
  EXPECT_TRUE(is_legal(from_hex(kGoldenLoop)));
}

/// The values of one byte of a message that are allowed.
struct Limit {
  std::string_view message;
  std::size_t offset = 0;
  bool (*allows)(unsigned value) = nullptr;
};

bool is_face(unsigned value) { return value <= 5; }

/// The direction of a connection below what there is to say of it.
template <unsigned kRemarks>
bool is_connection(unsigned value) {
  return is_face(value & 15U) && value >> 4U <= kRemarks;
}

bool is_planned(unsigned value) { return value < 30; }

template <unsigned kBits>
bool is_flags(unsigned value) {
  return (value & ~kBits) == 0;
}

template <unsigned kFirst, unsigned kLast>
bool is_within(unsigned value) {
  return kFirst <= value && value <= kLast;
}

/// The bytes that name one of several things; the last column is docs/wire.md in other words.
const Limit kLimits[] = {
    {kGoldenTrace[0].messages[0], 7, is_within<1, 12>},                        // join: wave
    {kGoldenTrace[0].messages[2], 7, is_within<1, 3>},                         // echo: wave
    {kGoldenTrace[0].messages[2], 18, is_within<0, 3>},                        // echo: doubt
    {kGoldenTrace[0].messages[1], 1, is_within<1, 2>},                         // appoint
    {kGoldenVectors[1], 1, [](unsigned v) { return is_planned(v & 0x3fU); }},  // planned down
    {kGoldenVectors[2], 1, is_planned},                                        // planned up
    {kGoldenLoop, 10, [](unsigned v) { return v == 0 || v == 2 || v == 4; }},
    {kGoldenVectors[3], 1, is_within<0, 57>},                                // column
    {kGoldenVectors[4], 1, is_within<0, 2>},                                 // branch up
    {kGoldenVectors[5], 1, is_within<0, 2>},                                 // branch down
    {kGoldenOrders[0], 2, [](unsigned v) { return v <= 30 || v == 0xff; }},  // plan
    {kGoldenOrders[1], 2, is_flags<0x3f>},                                   // hosts, the first ...
    {kGoldenOrders[1], 3, is_within<0, 0>},
    {kGoldenOrders[3], 2, is_within<5, 5>},    // angles: facet
    {kGoldenOrders[1], 14, is_flags<0x3f>},    // ... and the last
    {kGoldenOrders[1], 16, is_within<0, 4>},   // which part
    {kGoldenOrders[4], 2, is_flags<15>},       // begin
    {kGoldenOrders[5], 2, is_flags<3>},        // hold
    {kGoldenOrders[8], 2, is_within<2, 2>},    // verdict: overload, as the reason says
    {kGoldenOrders[8], 3, is_within<2, 2>},    // and the reason: breaks
    {kGoldenOrders[8], 17, is_connection<7>},  // with its limit, and gaps that open
    {kGoldenOrders[10], 2, is_flags<63>},      // iterate
    {kGoldenOrders[12], 2, is_flags<7>},       // clusters
    {kGoldenOrders[13], 2, is_flags<1>},       // forget
    {kGoldenReports[0], 2, is_flags<0x3f>},    // plan
    {kGoldenReports[0], 3, is_within<0, 0>},
    {kGoldenReports[0], 4, is_flags<63>},
    {kGoldenReports[1], 2, is_flags<0x9f>},   // hosts
    {kGoldenReports[2], 34, is_flags<15>},    // mass
    {kGoldenReports[3], 2, is_within<0, 2>},  // angles
    {kGoldenReports[6], 2, [](unsigned v) { return v <= 2 || v == 4; }},
    {kGoldenReports[7], 15, is_connection<15>},  // loads: with facets that may slip, too
    {kGoldenReports[10], 16, is_flags<25>},      // iterate
    {kGoldenReports[11], 16, is_flags<31>},      // tree iterate
    {kGoldenReports[13], 2, is_flags<0x3f>},     // forget
    {kGoldenReports[13], 4, is_flags<63>},
    {kGoldenOrders[17], 2, [](unsigned v) { return v <= 3 || v == 0xff; }},  // word 1 of 4
    {kGoldenOrders[17], 3, is_within<2, 16>},
    {kGoldenOrders[18], 2, is_within<0, 3>},  // stage
    {kGoldenOrders[18], 3, is_within<0, 3>},
    {kGoldenOrders[18], 4, is_within<0, 199>},
    {kGoldenReports[17], 2, is_flags<23>},  // word
    {kGoldenReports[17], 3, is_within<0, 3>},
    {kGoldenReports[18], 2, is_flags<1>},     // stage
    {kGoldenOrders[20], 2, is_flags<7>},      // next
    {kGoldenOrders[21], 2, is_flags<3>},      // seek
    {kGoldenOrders[15], 2, is_flags<0x5e>},   // resume
    {kGoldenOrders[15], 3, is_within<0, 4>},  // in whose place the last change is kept, or nowhere
    {kGoldenOrders[15], 26, is_flags<0x3f>},  // masks, the first ...
    {kGoldenOrders[15], 30, is_flags<0x3f>},  // ... and the last
    {kGoldenOrders[22], 2, is_flags<0x5e>},   // resume deflated
    {kGoldenOrders[22], 3, is_within<0, 4>},
    {kGoldenOrders[22], 26, is_flags<0x3f>},
    {kGoldenOrders[22], 30, is_flags<0x3f>},
    {kGoldenOrders[23], 2, is_flags<23>},     // iterate deflated: no clusters, no stand-ins
    {kGoldenOrders[24], 2, is_flags<23>},     // iterate last
    {kGoldenReports[15], 2, is_flags<0x9f>},  // resume
    {kGoldenReports[15], 3, is_within<0, 2>},
    {kGoldenReports[22], 2, is_flags<0x9f>},  // resume deflated
    {kGoldenReports[22], 3, is_within<0, 2>},
    {kGoldenReports[23], 16, is_flags<25>},  // iterate deflated
    {kGoldenReports[24], 16, is_flags<25>},  // iterate last
    {kGoldenReports[24], 57, [](unsigned v) { return v <= 2 || v == 4; }},
    {kGoldenReports[24], 85, is_connection<15>},
    {kGoldenVectors[8], 1, is_within<0, 6>},  // reach
    {kGoldenParts[0], 1, is_within<0, 42>},   // cells up
    {kGoldenParts[1], 1, is_within<0, 42>}};  // cells down

TEST(Legal, bytes_that_name_something_name_what_there_is) {
  for (const Limit& limit : kLimits) {
    auto message = from_hex(limit.message);
    for (unsigned value = 0; value <= 0xff; ++value) {
      message[limit.offset] = static_cast<std::uint8_t>(value);
      EXPECT_EQ(is_legal(message), limit.allows(value)) << to_hex(message);
    }
  }
}

/// Safe, overload and unstable have one reason each, undecided has the others that are told.
TEST(Legal, verdicts_have_a_reason_of_theirs) {
  auto message = from_hex(kGoldenOrders[8]);
  for (unsigned verdict = 0; verdict <= 5; ++verdict) {
    for (unsigned reason = 0; reason <= 0x20; ++reason) {
      message[2] = static_cast<std::uint8_t>(verdict);
      message[3] = static_cast<std::uint8_t>(reason);
      const bool is_sure = 1 <= verdict && verdict <= 3 && reason == verdict;
      const bool is_told = (4 <= reason && reason <= 11) || (14 <= reason && reason <= 19);
      const bool is_undecided = verdict == 4 && is_told;
      EXPECT_EQ(is_legal(message), is_sure || is_undecided) << to_hex(message);
    }
  }
}

/// kDegreeMax = 0x0fa0.
TEST(Legal, exchanges_are_bounded) {
  EXPECT_TRUE(is_legal(from_hex("05 11 00 a0 0f 00 00 00 00 00 00 00 00 00 00 00 00")));
  EXPECT_FALSE(is_legal(from_hex("05 11 00 a1 0f 00 00 00 00 00 00 00 00 00 00 00 00")));
  EXPECT_TRUE(is_legal(from_hex("05 05 06 a0 0f 00 00 00 3f 00 00 7a 44")));
  EXPECT_FALSE(is_legal(from_hex("05 05 06 a1 0f 00 00 00 3f 00 00 7a 44")));
  EXPECT_FALSE(is_legal(from_hex("05 13 06 a1 0f 00 00 00 3f 00 00 7a 44")));
  // The degrees of iterations, and of what begins with one.
  for (const auto& [text, offset] : {std::pair<std::string_view, std::size_t>{kGoldenOrders[15], 4},
                                     {kGoldenOrders[22], 4},
                                     {kGoldenOrders[23], 3},
                                     {kGoldenOrders[24], 3}}) {
    auto message = from_hex(text);
    message[offset] = 0xa0;
    message[offset + 1] = 0x0f;
    EXPECT_TRUE(is_legal(message)) << text;
    message[offset] = 0xa1;
    EXPECT_FALSE(is_legal(message)) << text;
  }
}

/// 4 x 65,534 + 1 = 0x3fff9; sides of cells are odd.
TEST(Legal, corners_are_those_of_cells_near_enough) {
  const auto angles = [](std::string_view x) {
    return is_legal(
        from_hex("06 04 01 " + std::string(x) + " 01 00 00 00 01 00 00 00 ff ff ff ff"));
  };
  EXPECT_TRUE(angles("f9 ff 03 00"));
  EXPECT_TRUE(angles("07 00 fc ff"));
  EXPECT_FALSE(angles("fb ff 03 00"));
  EXPECT_FALSE(angles("05 00 fc ff"));
  EXPECT_FALSE(angles("02 00 00 00"));
  EXPECT_FALSE(angles("00 00 00 80"));
}

/// How many faces there are says the lattice: six, eight or twelve.
TEST(Legal, faces_are_those_of_the_lattice) {
  const auto verdict = [](std::string_view face) {
    return from_hex("05 0f 02 02 00 00 c0 3f 01 00 00 fe ff ff 03 00 00 " + std::string(face));
  };
  const auto plan = [](std::string_view mask) {
    return from_hex("06 01 " + std::string(mask) + " 01 01 00 00 fe ff ff 03 00 00");
  };
  for (const int count : {6, 8, 12}) {
    EXPECT_TRUE(is_legal(verdict("05"), count));
    EXPECT_EQ(is_legal(verdict("06"), count), count > 6);
    EXPECT_EQ(is_legal(verdict("0b"), count), count == 12);
    EXPECT_FALSE(is_legal(verdict("0c"), count));
    EXPECT_TRUE(is_legal(plan("3f 00"), count));
    EXPECT_EQ(is_legal(plan("ff 00"), count), count > 6);
    EXPECT_EQ(is_legal(plan("ff 0f"), count), count == 12);
    EXPECT_FALSE(is_legal(plan("00 10"), count));
  }
}

/// How far to move along a change, and sums of what is kept: all reals, from the first byte to the
/// last, so the largest message too.
TEST(Legal, sums_along_what_is_kept_may_be_anything) {
  struct Reals {
    std::string_view message;
    std::size_t first = 0;
    std::size_t bytes = 0;
  };

  for (const Reals& reals : {Reals{kGoldenOrders[23], 17, 16}, Reals{kGoldenOrders[24], 17, 16},
                             Reals{kGoldenReports[22], 20, 56}, Reals{kGoldenReports[23], 41, 16},
                             Reals{kGoldenReports[24], 41, 16}}) {
    auto message = from_hex(reals.message);
    for (std::size_t i = 0; i < reals.bytes; ++i) {
      message[reals.first + i] = 0xff;
    }
    EXPECT_TRUE(is_legal(message)) << reals.message;
  }
}

/// The worst connection of the last iteration is one of the lattice, as that of `loads`.
TEST(Legal, the_last_iteration_tells_of_a_connection) {
  auto message = from_hex(kGoldenReports[24]);
  for (const int count : {6, 8, 12}) {
    for (unsigned face = 0; face <= 15; ++face) {
      message[85] = static_cast<std::uint8_t>(0xf0U | face);
      EXPECT_EQ(is_legal(message, count), face < static_cast<unsigned>(count)) << face;
    }
  }
  message = from_hex(kGoldenReports[24]);
  message[78] = 0x10;  // Its cell: 0x100001 is more than 1,000,000.
  EXPECT_FALSE(is_legal(message));
}

TEST(Legal, rounds_have_a_number) {
  EXPECT_FALSE(is_legal(from_hex("01 00 00 0a 00 00 00 01 ff ff ff 02 00 00 00 00 00 00 00")));
  EXPECT_TRUE(is_legal(from_hex("01 ff ff 0a 00 00 00 01 ff ff ff 02 00 00 00 00 00 00 00")));
}

/// 1,000,000 = 0x0f4240, in 24 bits.
TEST(Legal, cells_stay_within_the_lattice) {
  EXPECT_TRUE(is_legal(from_hex("05 03 40 42 0f c0 bd f0 00 00 00")));
  EXPECT_FALSE(is_legal(from_hex("05 03 41 42 0f c0 bd f0 00 00 00")));
  EXPECT_FALSE(is_legal(from_hex("05 03 00 00 00 bf bd f0 00 00 00")));
  EXPECT_FALSE(is_legal(from_hex("05 03 00 00 00 00 00 00 00 00 80")));
}

/// -2^23 is 80 00 00. It stands for all plans only in all three places, and is never planned.
TEST(Legal, all_plans_are_a_cell_of_plans_that_end_only) {
  constexpr std::string_view kAll = " 00 00 80 00 00 80 00 00 80";
  constexpr std::string_view kPart = " 00 00 80 00 00 80 00 00 00";
  for (const std::string_view front : {"05 14 00", "06 14 00 00 04", "06 01 00 00 04"}) {
    EXPECT_TRUE(is_legal(from_hex(std::string(front).append(kAll)))) << front;
    EXPECT_FALSE(is_legal(from_hex(std::string(front).append(kPart)))) << front;
  }
  EXPECT_FALSE(is_legal(from_hex(std::string("05 01 00").append(kAll))));
}

}  // namespace
}  // namespace holdfast::agent
