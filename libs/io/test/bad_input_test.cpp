// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What cannot be read is refused with one line that says where, what was found and what is allowed;
// quickly, and without much memory or stack, whatever the input.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>

#include "document_support.hpp"
#include "holdfast/base/rng.hpp"

namespace holdfast::io {
namespace {

using document_test::json;

struct BadInput {
  std::string text;
  std::string where;
  std::string message;  ///< A part of it.
  base::ErrorCode code = base::ErrorCode::kBadInput;
};

bool is_printable_line(std::string_view text) {
  return text.size() < 400 &&
         std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

void expect_refusal(const BadInput& input) {
  SCOPED_TRACE(input.text.substr(0, 300));
  const auto read = read_document(input.text);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().where, input.where);
  EXPECT_NE(read.error().message.find(input.message), std::string::npos) << read.error().message;
  EXPECT_EQ(read.error().code, input.code);
  EXPECT_TRUE(is_printable_line(read.error().message)) << read.error().message;
}

std::string repeated(std::string_view unit, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += unit;
  }
  return text;
}

/// A world with these blocks in line 3.
std::string xml(std::string_view blocks) {
  return "<parameters/>\n<world gridSize=\"1000,1000,1000\"><blockList>\n" + std::string(blocks) +
         "</blockList></world>";
}

TEST(BadInput, without_a_structure_is_refused) {
  expect_refusal({"", "", "empty"});
  expect_refusal({" \n\t\r\n ", "", "empty"});
  expect_refusal({"\xEF\xBB\xBF", "", "empty"});
  expect_refusal({"modules: 3", "", "found 'modules:' at the beginning"});
  expect_refusal(
      {"\x7F"
       "ELF\x02",
       "", "found '?ELF?' at the beginning"});
  for (const char* text : {"", "  "}) {
    EXPECT_FALSE(read_json(text));
    EXPECT_FALSE(read_visiblesim(text));
    EXPECT_FALSE(detect_format(text));
  }
}

TEST(BadInput, that_is_no_text_is_refused) {
  expect_refusal({std::string("{\n\0}", 4), "line 2", "0x00"});
  expect_refusal({"<world>\n\n\xFF</world>", "line 3", "0xFF"});
  expect_refusal({json("\"name\": \"\xC0\x80\""), "line 1", "0xC0"});          // Overlong form.
  expect_refusal({json("\"name\": \"\xED\xA0\x80\""), "line 1", "0xED"});      // Half of a pair.
  expect_refusal({json("\"name\": \"\xF5\x80\x80\x80\""), "line 1", "0xF5"});  // Beyond Unicode.
  expect_refusal({"<world a=\"\xE2\x82", "line 1", "0xE2"});                   // Cut short.
  expect_refusal({xml("<block position=\"0,0,0\" id=\"&#7;\"/>"), "line 3", "0x07"});
  expect_refusal({xml("<block position=\"0,0,0\" id=\"&#xD800;\"/>"), "line 3", "not UTF-8"});
  expect_refusal({json("\"name\": \"\\u001b[2J\", \"modules\": []"), "/name", "0x1B"});
  expect_refusal({json("\"name\": \"a\\u0000b\", \"modules\": []"), "/name", "0x00"});
}

TEST(BadInput, beyond_the_size_limit_is_refused) {
  // Zero pages that nobody touches.
  const std::unique_ptr<char, void (*)(void*)> bytes(
      static_cast<char*>(std::calloc(kFileBytesMax + 1, 1)), std::free);
  ASSERT_TRUE(bytes);
  for (const auto& read : {read_json, read_visiblesim}) {
    const auto result = read({bytes.get(), kFileBytesMax + 1}, {});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, base::ErrorCode::kUnreadable);
    EXPECT_NE(result.error().message.find("1073741825 bytes"), std::string::npos);
  }
}

TEST(BadInput, nested_a_million_deep_is_refused) {
  expect_refusal({repeated("[", 1'000'000), "line 1", "nested deeper than the 64"});
  expect_refusal({repeated("{\"a\":", 1'000'000), "line 1", "nested deeper than the 64"});
  expect_refusal({repeated("<a>", 1'000'000), "line 1", "nested deeper than the 64"});
  expect_refusal({repeated("<a b='>'>\n", 1'000'000), "line 65", "nested deeper than the 64"});
  // Brackets in strings are no brackets.
  EXPECT_TRUE(
      read_document(json("\"modules\": [], \"name\": \"\\\"" + repeated("[{", 999) + "\"")));
  EXPECT_TRUE(read_document("<!--" + repeated("<a>", 999) + "-->" + xml("")));
}

TEST(BadInput, with_scenery_nested_beyond_what_both_formats_hold_is_refused) {
  const auto nested = [](std::size_t depth) {
    return "<world><blockList/>" + repeated("<a>", depth) + repeated("</a>", depth) + "</world>";
  };
  EXPECT_TRUE(read_document(nested(16)));
  expect_refusal({nested(17), "line 1", "nested deeper than the 16"});
}

TEST(BadInput, of_more_modules_than_allowed_is_refused_before_they_are_made) {
  expect_refusal({xml("<blockBox/>"), "line 3", "20000000"});
  // One cell, then 999 x 999 x 21, as VisibleSim leaves out the last layer of the grid.
  expect_refusal({xml("<blockBox boxSize=\"0,0,0\"/>\n<blockBox boxSize=\"1000,1000,21\"/>"),
                  "line 4", "more than the 20000000 cells that are allowed, with 20958021 here"});
}

TEST(BadInput, in_a_place_with_a_long_name_is_refused_with_the_end_of_it) {
  std::string place = "\"k\": 0, \"k\": 1";
  for (int i = 0; i < 40; ++i) {
    place = "\"" + repeated("long", 30) + "\": {" + place + "}";
  }
  const auto read = read_document(json(place));
  ASSERT_FALSE(read);
  EXPECT_LT(read.error().where.size(), 300U);
  EXPECT_TRUE(read.error().where.starts_with(".../long"));
  EXPECT_TRUE(read.error().where.ends_with("long/k"));
}

TEST(BadInput, of_endless_strings_is_refused) {
  const std::string a_million(1'000'000, 'a');
  const std::string nine_million = repeated(a_million, 9);
  for (const char* begin : {"{\"", "{\"a\": \"", "{\"a\": 1", "{\"a\": x"}) {
    expect_refusal({begin + nine_million, "line 1", "longer than the 8388608 bytes"});
  }
  expect_refusal({json("\"modules\": [], \"name\": \"" + a_million + a_million + "\""), "/name",
                  "has 2000000 bytes, expected at most 1048576"});
  expect_refusal(
      {"<world " + a_million + "=''><blockList/></world>", "line 1", "up to 256 letters"});
  expect_refusal({"<world a='" + a_million + a_million + "'><blockList/></world>", "line 1",
                  "has 2000000 bytes, expected at most 1048576"});
}

TEST(BadInput, of_endless_objects_is_refused) {
  std::string members;
  for (int i = 0; i < 300; ++i) {
    members += "\"k" + std::to_string(i) + "\": 0, ";
  }
  expect_refusal({json(members + "\"modules\": []"), "/k254", "more than 256 keys"});
}

TEST(BadInput, with_a_merge_conflict_says_so) {
  expect_refusal(
      {"<?xml version=\"1.0\"?>\n<<<<<<< HEAD\n<parameters/>\n=======\n<parameters/>\n"
       ">>>>>>> c058104\n<world/>",
       "line 2", "unresolved merge-conflict marker at '<<<<<<< HEAD'"});
  expect_refusal({xml("<block position=\"0,0,0\"/>\n=======\n<block position=\"1,0,0\"/>\n"),
                  "line 3", "unresolved merge-conflict marker at '======='"});
  expect_refusal({"{\n\"format\": 1,\n>>>>>>> theirs\n}", "line 3", "merge-conflict marker"});
}

TEST(BadInput, that_breaks_the_rules_of_xml_is_refused_with_its_line) {
  expect_refusal({"<world>\n<blockList>\n</world>", "line 3",
                  "no well-formed XML: the element 'blockList' of line 2 is not closed at "
                  "'</world>'"});
  expect_refusal({"<world>\n<blockList>\n<block a='/>'/><!-- <b> -->", "line 3",
                  "the element 'blockList' of line 2 is not closed, found the end of the text"});
  expect_refusal({"<world\x01>", "line 1", "no well-formed XML"});
  expect_refusal({"<world><blockList/>", "line 1", "no well-formed XML"});
  expect_refusal(
      {"<world>\n<block fixed=\"&f;\"/></world>", "line 2", "the entity &f; is unknown"});
  expect_refusal({"<world name='a&#0;b'/>", "line 1", "the entity &#0; is unknown"});
  expect_refusal({"<world name='a&#x00;b'/>", "line 1", "the entity &#x00; is unknown"});
  expect_refusal({"<!DOCTYPE html><html><body/></html>", "", "found no element <world>"});
  expect_refusal({"<parameters/>\n<world/>", "line 2", "<blockList>"});
  expect_refusal({xml("") + "\n<world/>", "line 4", "a second <world>"});
  expect_refusal({"<parameters/>\n<parameters/><world/>", "line 2", "a second <parameters>"});
}

TEST(BadInput, of_visiblesim_names_what_was_found_and_what_is_allowed) {
  const auto bad_block = [](std::string_view attributes, std::string_view message) {
    expect_refusal(
        {xml("<block " + std::string(attributes) + "/>"), "line 3", std::string(message)});
  };
  bad_block("", "<block> has no attribute 'position'");
  bad_block("positon=\"1,2,3\" id=\"1\"",
            "<block> has no attribute 'position', found 'positon', 'id'");
  for (const char* position : {"1", "1,2,3,4", "1,2,x", "1,2,3x", "1,2,", "", "1;2;3", "1 2 3",
                               "1,2,99999999999", "1,2,1000001", "1,2,0x10", "nan,0,0"}) {
    bad_block("position=\"" + std::string(position) + "\"",
              "position of <block> is '" + std::string(position) +
                  "', expected three integers from -1000000 to 1000000, such as 1,2,3");
  }
  bad_block("position=\"0,0,0\" position=\"1,1,1\"", "'position' of 'block' is there twice");
  bad_block("position=\"0,0,0\" id=\"" + repeated("\x7F", 3) + "\"\n id=\"1\"", "'id'");
}

TEST(BadInput, of_lines_and_boxes_is_refused) {
  expect_refusal({xml("<blocksLine line=\"1\"/>"), "line 3", "no attribute 'values'"});
  expect_refusal(
      {xml("<blocksLine line=\"1.5\" values=\"1\"/>"), "line 3", "line of <blocksLine>"});
  expect_refusal({xml("<blockBox boxSize=\"1,2\"/>"), "line 3", "boxSize of <blockBox> is '1,2'"});
  expect_refusal({xml("<blockBox boxOrigin=\"0,0,inf\"/>"), "line 3", "three numbers"});
  expect_refusal({"<world><blockList><blockBox/></blockList></world>", "line 1", "gridSize"});
  expect_refusal(
      {"<world gridSize=\"9,9,9\"><blockList blockSize=\"0,1,1\"><blockBox/></blockList>"
       "</world>",
       "line 1", "blockSize of <blockList> is '0,1,1'"});
  expect_refusal(
      {"<world gridSize=\"9,0,9\"><blockList/></world>", "line 1", "gridSize is '9,0,9'"});
  expect_refusal({xml("<csg/>"), "line 3", "no attribute 'content'"});
  expect_refusal({xml("<csg content=\"ball(1)\"/>"), "line 3", "found 'ball(1)' in content"});
  expect_refusal({xml("<mesh/>"), "line 3", "<mesh>", base::ErrorCode::kUnsupported});
}

TEST(BadInput, of_parameters_is_refused) {
  for (const char* value : {"nan", "inf", "-inf", "1e999", "heavy", "", "0.06 kg", "0,06"}) {
    expect_refusal(
        {"<parameters globalMass=\"" + std::string(value) + "\"/><world/>", "line 1",
         "globalMass of <parameters> is '" + std::string(value) + "', expected a finite number"});
  }
  expect_refusal({"<parameters globalSupportZ=\"0.5\"/><world/>", "line 1",
                  "globalSupportZ of <parameters> is '0.5', expected an integer"});
  expect_refusal({"<world><blockList/><holdfast><knownAnswer verdict=\"fine\"/></holdfast></world>",
                  "line 1", "the known verdict is 'fine', expected safe, overload or unstable"});
}

TEST(BadInput, that_breaks_the_rules_of_json_is_refused_with_its_line) {
  const auto bad = [](std::string text, std::string_view where, std::string_view message) {
    expect_refusal({std::move(text), std::string(where), "no valid JSON: " + std::string(message)});
  };
  bad("{\n\"format\": holdfast}", "line 2, column 11", "expected a value, found 'holdfast'");
  bad("{\"a\": 1,\n}", "line 2, column 1",
      "expected a key in double quotes, found '}'; remove the ',' before '}'");
  bad("[[0,0,0],]", "line 1, column 10", "expected a value, found ']'; remove the ',' before ']'");
  bad("{}\n{}", "line 2, column 1", "expected nothing behind the end, found '{'");
  bad("{}}", "line 1, column 3", "expected nothing behind the end, found '}'");
  bad("{\"a\": 1\n", "line 2, column 1",
      "expected ',' or '}', found the end of the text; the object that begins in line 1, column 1 "
      "is not closed");
  bad("{\"b\": 1,\n \"cells\": [[0,0,0]}", "line 2, column 19",
      "expected ',' or ']', found '}'; the array 'cells' that begins in line 2, column 11 is not "
      "closed");
  bad("{", "line 1, column 2", "expected a key in double quotes or '}', found the end of the text");
  bad("{\"a\" 1}", "line 1, column 6", "expected ':' behind a key, found '1'");
  bad("[1 2]", "line 1, column 4", "expected ',' or ']', found '2'");
  // A letter of two bytes is one column.
  bad("{\"\xC3\xA4\": x}", "line 1, column 7", "expected a value, found 'x'");
}

TEST(BadInput, that_other_languages_would_take_is_no_json_and_is_told_what_json_has) {
  const auto bad = [](std::string_view value, std::string_view message) {
    const auto read = read_json("[" + std::string(value) + "]");
    ASSERT_FALSE(read) << value;
    const base::Error& error = read.error();
    EXPECT_TRUE(is_printable_line(error.message));
    EXPECT_EQ(error.where, "line 1, column 2") << value;
    EXPECT_NE(error.message.find(message), std::string::npos) << error.message;
  };
  for (const char* comment : {"// x", "/* x */", "# x"}) {
    bad(comment, "; JSON has no comments");
  }
  bad("'a'", "; keys and strings stand in straight double quotes");
  bad("\xE2\x80\x9Cx\xE2\x80\x9D", "; keys and strings stand in straight double quotes");
  bad("(0,0,0)", "found '(0'; a cell is [x, y, z]");
  for (const char* word : {"True", "FALSE", "None"}) {
    bad(word, "; JSON has true, false and null");
  }
  for (const char* word : {"NaN", "Infinity", "-Infinity"}) {
    bad(word, "; numbers are finite");
  }
  for (const char* word : {"+1", ".5", "5.", "01", "1e", "0x10", "-"}) {
    bad(word, "found '" + std::string(word) + "'; numbers are written as 12, -0.5 or 1e-3");
  }
  bad("\"a\nb\"", "a string ends in the line in which it begins");
  bad("\"C:\\models\"", "in a string '\\' is written as '\\\\'");
  bad("\"abc", "'\"' is missing at the end of a string");
}

TEST(BadInput, of_a_number_or_key_beyond_what_is_read_is_refused) {
  expect_refusal({"{\"a\":\n1e999}", "line 2", "a number beyond the range of double"});
  expect_refusal({json("\"modules\": [[0,0,0]], \"modules\": []"), "/modules", "same key twice"});
  expect_refusal({json("\"modules\": [[0,0,0], {\"cell\": 1, \"cell\": 2}]"), "/modules/1/cell",
                  "same key twice"});
}

TEST(BadInput, of_another_json_format_is_refused) {
  expect_refusal({"{\"format\": \"gltf\", \"version\": 1}", "/format",
                  "expected \"holdfast-structure\", found 'gltf'"});
  expect_refusal({"{}", "", "key \"format\" is missing"});
  expect_refusal({"[]", "", "expected an object such as {\"format\": \"holdfast-structure\", "});
  expect_refusal(
      {"{\"format\": \"holdfast-structure\"}", "", "key \"version\" is missing, expected 1 or 2"});
  expect_refusal({"{\"format\": \"holdfast-structure\", \"version\": 3}", "/version",
                  "expected version 1 to 2, found 3: this program knows no newer one",
                  base::ErrorCode::kUnsupported});
  expect_refusal(
      {"{\"format\": \"holdfast-structure\", \"version\": 1, \"blocks\": []}", "",
       "key \"modules\" is missing, expected an array of cells; found an object with 'format', "
       "'version', 'blocks'"});
}

TEST(BadInput, of_json_names_what_was_found_and_what_is_allowed) {
  const auto bad = [](std::string_view members, std::string_view where, std::string_view message) {
    expect_refusal({json(members), std::string(where), std::string(message)});
  };
  bad(R"("modules": {})", "/modules",
      "expected an array of cells [x, y, z], found an empty object");
  bad(R"("modules": [7])", "/modules/0",
      "expected a cell [x, y, z] or an object with the key \"cell\", found 7");
  bad(R"("modules": [[1,2]])", "/modules/0", "expected three integers, found an array of 2");
  bad(R"("modules": [[0,0,0], [1,2,3.5]])", "/modules/1/2",
      "expected an integer from -1000000 to 1000000, found 3.5");
  bad(R"("modules": [[0,0,99999999999999]])", "/modules/0/2", "found 99999999999999");
  bad(R"("modules": [{"x": 0, "y": 0}])", "/modules/0", "found an object with 'x', 'y'");
  bad(R"("modules": [], "material": "PLA")", "/material", "an object of numbers, such as {");
  bad(R"("modules": [], "support_z": null)", "/support_z", "needs \"version\": 2");
  bad(R"("modules": [[0,0,"1"]])", "/modules/0/2",
      "expected an integer from -1000000 to 1000000, found '1'");
  bad(R"("modules": [{"fixed": true}])", "/modules/0", "the key \"cell\"");
  bad(R"("modules": [{"cell": [0,0,0], "fixed": 1}])", "/modules/0/fixed", "true or false");
  bad(R"("modules": [{"cell": [0,0,0], "color": [0,0,300]}])", "/modules/0/color/2", "0 to 255");
  bad(R"("modules": [], "support_z": 1e9)", "/support_z", "expected an integer");
  bad(R"("modules": [], "name": 5)", "/name", "expected a string, found 5");
  bad(R"("modules": [], "material": {"mass_kg": "1"})", "/material/mass_kg", "a number");
  bad(R"("modules": [], "later_steps": [[[0,0]]])", "/later_steps/0/0", "an array of 2");
  bad(R"("modules": [], "known_answer": {"margin_mm": 1})", "/known_answer", "\"verdict\"");
}

TEST(BadInput, that_visiblesim_could_not_hold_is_refused) {
  const auto bad = [](std::string_view visiblesim, std::string_view where) {
    expect_refusal({json("\"modules\": [], \"visiblesim\": {" + std::string(visiblesim) + "}"),
                    "/visiblesim/" + std::string(where), ""});
  };
  bad(R"("world": {"grid size": "1"})", "world/grid size");
  bad(R"("world": {"gridSize": "1"})", "world");
  bad(R"("world": {"": "1"})", "world/");
  bad(R"("world": {"a": 1})", "world/a");
  bad(R"("parameters": {"globalMass": "1"})", "parameters/globalMass");
  bad(R"("scenery": [{"element": "blockList"}])", "scenery");
  bad(R"("scenery": [{"element": "<camera>"}])", "scenery/0/element");
  bad(R"("scenery": [{}])", "scenery/0");
  bad(R"("targets": [{"element": "target", "attributes": {"format": "grid"}}])", "targets");
  expect_refusal({json(R"("modules": [{"cell": [0,0,0], "attributes": {"position": "1,1,1"}}])"),
                  "/modules/0/attributes/position", "key of its own"});
}

/// Coordinates in millimetres make a robot of modules that are far apart.
TEST(BadInput, that_counts_cells_in_millimetres_is_told_so) {
  const auto message = [](std::string_view cells) {
    const auto read = read_document(json(fmt::format(R"("modules": [{}])", cells)));
    EXPECT_TRUE(read);
    const auto robot = make_robot(read.value().document);
    EXPECT_FALSE(robot);
    return robot.error().message;
  };
  const std::string_view hint = "divide them by 40";
  EXPECT_NE(message("[0,0,0], [40,0,0], [40,0,40]").find(hint), std::string::npos);
  EXPECT_NE(message("[7,0,0], [47,0,0]").find(hint), std::string::npos);
  EXPECT_EQ(message("[0,0,0], [40,0,0], [120,0,0]").find("divide"), std::string::npos);
  EXPECT_EQ(message("[0,0,0], [40,0,0], [41,0,0]").find("divide"), std::string::npos);
}

TEST(BadInput, cut_off_or_damaged_anywhere_never_ends_in_more_than_a_message) {
  const std::string texts[] = {
      json(R"("modules": [[0,0,0], {"cell": [1,0,0], "color": [1,2,3]}], "planned": [[2,0,0]],
              "visiblesim": {"scenery": [{"element": "a", "text": "b"}]})"),
      xml("<block position=\"0,0,0\" id='&lt;'/><blocksLine values=\"01\"/><!-- c -->")};
  base::Rng rng(7);
  for (const std::string& text : texts) {
    ASSERT_TRUE(read_document(text));
    for (std::size_t i = 0; i < text.size(); ++i) {
      std::string damaged = text;
      damaged[i] = static_cast<char>(rng.below(256));
      for (const std::string& input : {text.substr(0, i), damaged}) {
        const auto read = read_document(input);
        if (!read) {
          EXPECT_FALSE(read.error().message.empty());
          EXPECT_TRUE(is_printable_line(read.error().message)) << read.error().message;
          EXPECT_TRUE(is_printable_line(read.error().where)) << read.error().where;
        }
      }
    }
  }
}

}  // namespace
}  // namespace holdfast::io
