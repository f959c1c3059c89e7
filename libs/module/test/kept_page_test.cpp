// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Pages that a module keeps in its flash: at whichever operation the power fails, and whatever that
// operation leaves behind, the page afterwards is the old one or the new one.
#include "holdfast/module/kept_page.hpp"

#include <gtest/gtest.h>

#include <random>

#include "board.hpp"

namespace holdfast::module {
namespace {

/// The power fails; what the flash was doing is done in part.
struct PowerFails {};

/// Flash after RM0091, 3.2.2: erasing makes ones, programming zeros, of erased half-words or to
/// zero.
class TestFlash final : public FlashPlaces {
 public:
  explicit TestFlash(std::uint64_t seed) : noise_(seed) {
    for (auto& place : places_) {
      place.fill(0xff);
    }
  }

  const std::uint8_t* bytes(int place) override { return places_.at(at(place)).data(); }

  void erase(int place) override {
    ++erasures.at(at(place));
    const bool fails = is_over();
    for (std::uint8_t& byte : places_.at(at(place))) {
      byte = static_cast<std::uint8_t>(byte | (fails ? noise_() : 0xffU));
    }
    end(fails);
  }

  void program(int place, std::size_t offset, std::uint16_t value) override {
    auto& bytes = places_.at(at(place));
    const auto before = static_cast<std::uint16_t>(bytes.at(offset) | bytes.at(offset + 1) << 8);
    ASSERT_TRUE(offset % 2 == 0 && (before == 0xffff || value == 0)) << "as the chip refuses it";
    const bool fails = is_over();
    const auto left = static_cast<std::uint16_t>(before & (value | (fails ? noise_() : 0U)));
    bytes.at(offset) = static_cast<std::uint8_t>(left & 0xffU);
    bytes.at(offset + 1) = static_cast<std::uint8_t>(left >> 8U);
    end(fails);
  }

  /// A programmer writes a page into the first place.
  void flash(const Bytes& page) {
    places_[0].fill(0xff);
    std::ranges::copy(page, places_[0].begin());
  }

  /// The power fails in the midst of the operation after so many.
  void fail_after(int count) { left_ = count; }

  std::array<int, kCount> erasures{};

 private:
  /// What lies there is aligned as a configuration is.
  struct alignas(8) Place : std::array<std::uint8_t, kBytes> {};

  static std::size_t at(int place) { return static_cast<std::size_t>(place); }

  bool is_over() { return left_-- == 0; }

  static void end(bool fails) {
    if (fails) {
      throw PowerFails{};
    }
  }

  std::array<Place, kCount> places_{};
  std::mt19937_64 noise_;
  int left_ = -1;
};

/// What a module finds when it starts.
Bytes found(TestFlash& flash) {
  const int place = find_kept_page(flash);
  return place < 0 ? Bytes() : Bytes(flash.bytes(place), flash.bytes(place) + kConfigurationBytes);
}

TEST(KeptPage, is_not_there_in_erased_flash_and_a_flashed_one_is) {
  TestFlash flash(1);
  EXPECT_EQ(find_kept_page(flash), -1);
  const Bytes page = page_of(7, true);
  flash.flash(page);
  EXPECT_EQ(found(flash), page);
}

TEST(KeptPage, is_the_last_one_that_was_kept_and_wears_both_places_alike) {
  constexpr int kChanges = 2000;
  TestFlash flash(2);
  for (int i = 0; i < kChanges; ++i) {
    const Bytes page = page_of(static_cast<std::uint32_t>(i + 1), i % 3 == 0);
    keep_page(flash, page);
    ASSERT_EQ(found(flash), page) << i;
  }
  EXPECT_EQ(flash.erasures[0] + flash.erasures[1], kChanges);
  EXPECT_EQ(flash.erasures[0], flash.erasures[1]);
}

TEST(KeptPage, that_is_the_same_is_not_written) {
  TestFlash flash(3);
  const Bytes page = page_of(7, true);
  keep_page(flash, page);
  const auto before = flash.erasures;
  keep_page(flash, page);
  EXPECT_EQ(flash.erasures, before);
  flash.flash(page);
  keep_page(flash, page);
  EXPECT_EQ(flash.erasures, before);
}

/// Numbers count over at 65,535, which erased flash has.
TEST(KeptPage, numbers_count_over) {
  TestFlash flash(4);
  for (std::uint32_t i = 0; i < 66'000; ++i) {
    const Bytes page = page_of(i % 2 + 1, false);
    keep_page(flash, page);
    if (i > 65'500) {
      ASSERT_EQ(found(flash), page) << i;
    }
  }
}

TEST(KeptPage, of_a_programmer_holds_over_those_that_were_kept) {
  for (int kept = 1; kept < 4; ++kept) {
    TestFlash flash(5);
    for (int i = 0; i < kept; ++i) {
      keep_page(flash, page_of(static_cast<std::uint32_t>(i + 1), false));
    }
    const Bytes page = page_of(99, true);
    flash.flash(page);
    EXPECT_EQ(found(flash), page) << kept;
    const Bytes next = page_of(100, true);
    keep_page(flash, next);
    EXPECT_EQ(found(flash), next) << kept;
  }
}

/// Histories of changes, each broken off a few times at random before it is told again; the first
/// page is none, a flashed one or a kept one.
TEST(KeptPage, is_the_old_or_the_new_one_when_the_power_fails) {
  std::mt19937_64 draw(6);
  int fail_count = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    TestFlash flash(seed);
    if (seed % 3 == 1) {
      flash.flash(page_of(500, true));
    }
    Bytes old = found(flash);
    for (std::uint32_t change = 0; change < 3; ++change) {
      const Bytes page = page_of(static_cast<std::uint32_t>(draw() % 1000 + 1), draw() % 2 == 0);
      for (int attempt = 0; attempt < 3; ++attempt) {
        // Most operations program half-words; the few others are no less likely.
        const auto at = static_cast<int>(draw() % 2 == 0 ? draw() % 6 : draw() % 160);
        flash.fail_after(at);
        try {
          keep_page(flash, page);
        } catch (const PowerFails&) {
          ++fail_count;
        }
        flash.fail_after(-1);
        const Bytes now = found(flash);
        ASSERT_TRUE(now == old || now == page) << "seed " << seed << ", failed at " << at;
        old = now;
      }
      keep_page(flash, page);
      ASSERT_EQ(found(flash), page) << "seed " << seed;
      old = page;
    }
  }
  EXPECT_GT(fail_count, 10'000);
}

}  // namespace
}  // namespace holdfast::module
