# SPDX-License-Identifier: MIT
# Shows that house_test.cmake (HOUSE_TEST) catches each kind of disorder, planted in a small tree below WORK, and only that.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK})

function(plant path text)
  file(WRITE ${WORK}/${path} "${text}\n")
endfunction()

# The house test must find each of the given texts, or nothing at all where there are none.
function(expect)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${WORK} "-DPUBLIC_HEADERS=oblique/text/a.h" -P ${HOUSE_TEST}
    RESULT_VARIABLE status ERROR_VARIABLE output OUTPUT_QUIET)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(NOT ARGN AND NOT status EQUAL 0)
    message(FATAL_ERROR "an orderly house was refused:${output}")
  endif()
  foreach(text IN LISTS ARGN)
    string(FIND "${output}" "${text}" at)
    if(status EQUAL 0 OR at EQUAL -1)
      message(FATAL_ERROR "'${text}' was not found in:${output}")
    endif()
  endforeach()
endfunction()

plant(CMakeLists.txt "")
plant(src/oblique/text/a.h "#include <string>\n// \"--help\" of the program\nnamespace oblique::text {")
plant(src/oblique/diagram/a.cpp "#include <oblique/text/a.h>\nstd::snprintf(text)\n// as std::jthread does")
plant(src/oblique/diagram/a.h "json[\"tour\"] = detour  // a surface that is drawn")
plant(src/oblique/solve/events/tested.h "")
plant(src/oblique/solve/events/tested.cpp "")
plant(src/oblique/solve/events/covered.h "/// On a switching surface.")
plant(src/oblique/solve/events/covered.cpp "")
plant(tests/solve/tested_test.cpp "")
plant(tests/solve/events/other_test.cpp "")
plant(tests/covered_by.txt "# which test covers which unit\nsolve/events/covered: solve/events/other_test.cpp")
plant(tests/CMakeLists.txt "oblique_test(all SOURCES a_test.cpp events/other_test.cpp tested_test.cpp)")
plant(src/oblique/patch/a.h "")
plant(src/oblique/patch/a.cpp "add_block(name, \"sine\", {})\nif (parameter.name == \"sine\" || definition.symbol == \"sine\") return")
plant(tests/diagram/a_test.cpp "")
plant(tests/patch/a_test.cpp "")
plant(blocks/CMakeLists.txt "set(blocks sine.toml)")
plant(blocks/sine.toml "")
plant(src/machines/CMakeLists.txt "set(machines tr-10.toml)")
plant(src/machines/tr-10.toml "")
expect()

plant(src/oblique/text/a.h "#include <toml++/toml.h>\n#include <oblique/text/hidden.h>")
plant(src/oblique/text/hidden.h "#include <oblique/diagram/a.h>")
plant(src/oblique/mechanism/a.cpp "#include <oblique/diagram/a.h>\n#include \"../text/a.h\"")
plant(src/oblique/cellar/a.cpp "")
plant(src/oblique/solve/a.cpp "std::cerr << 1")
plant(src/oblique/network/a.cpp "if (block.definition->name == \"sine\") return")
plant(src/oblique/network/b.cpp "if (\"sine\" != type) return")
plant(src/oblique/machine/a.cpp "library.find(\"sine\")")
plant(src/oblique/machine/b.cpp "kRoles{{\"sine\", Role::other}}")
plant(src/oblique/diagram/a.h "std::ranges::equal(a, b)")
plant(src/oblique/solve/b.cpp "namespace oblique {\n\"end it with --until\"")
plant(src/oblique/solve/c.cpp "namespace oblique::text {\n\"see oblique check\"")
plant(src/oblique/solve/events/stray.cpp "std::vector<double> surfaces_;")
plant(src/oblique/draw/a.h "/// The hinge.")
plant(src/oblique/patch/b.h "double longest_tour() {")
plant(tests/solve/events/forgotten_test.cpp "")
plant(tests/covered_by.txt "solve/events/gone: solve/events/other_test.cpp
solve/events/tested: solve/tested_test.cpp
solve/events/covered: solve/events/gone_test.cpp
solve/events/covered other_test.cpp")
plant(blocks/servo.toml "source = \"003_69ea068b7b221c3d.txt\"")
foreach(k RANGE 32)
  plant(src/cli/verb_${k}.cpp "")
endforeach()
plant(blocks/cosine.toml "")
plant(src/machines/ec-1.toml "")
plant(notes.txt "")
plant(.hidden "")
expect(
  "src/oblique/text/a.h: no SUNDIALS or toml++ in a public header"
  "src/oblique/text/a.h: includes <oblique/text/hidden.h>, which is not installed"
  "src/oblique/text/hidden.h: stage 'text' may not know stage 'diagram'"
  "src/oblique/diagram/a.h: the page's compiler has no such thing in its standard library"
  "src/oblique/mechanism/a.cpp: stage 'mechanism' may not know stage 'diagram'"
  "src/oblique/mechanism/a.cpp: includes begin with oblique/, not with ../"
  "src/oblique/cellar/a.cpp: there is no stage 'cellar'"
  "src/oblique/network/a.cpp: no stage knows a block by its name"
  "src/oblique/network/b.cpp: no stage knows a block by its name"
  "src/oblique/machine/a.cpp: no stage knows a block by its name"
  "src/oblique/machine/b.cpp: no stage knows a block by its name"
  "src/oblique/solve/b.cpp: its namespace is oblique::solve"
  "src/oblique/solve/b.cpp: no stage spells an option or a verb"
  "src/oblique/solve/c.cpp: its namespace is oblique::solve"
  "src/oblique/solve/c.cpp: no stage spells an option or a verb"
  "src/oblique/solve/events/stray.cpp: words that the glossary has replaced"
  "src/oblique/draw/a.h: words that the glossary has replaced"
  "src/oblique/patch/b.h: words that the glossary has replaced"
  "src/cli: more than 32 units"
  "src/oblique/solve/events/stray.cpp: a unit has a header of its name"
  "src/oblique/solve/events/stray.cpp: has no test of its name, and no line in tests/covered_by.txt"
  "tests/covered_by.txt: there is no unit 'solve/events/gone'"
  "tests/covered_by.txt: 'solve/events/tested' has a test of its name"
  "tests/covered_by.txt: solve/events/covered: there is no test 'solve/events/gone_test.cpp'"
  "tests/covered_by.txt: 'solve/events/covered other_test.cpp' is not of the form UNIT: TEST"
  "tests/solve/events/forgotten_test.cpp: is not in the list of tests/CMakeLists.txt"
  "blocks/servo.toml: cites a file that no reader has"
  "src/oblique/solve/a.cpp: the library never prints and never exits"
  "blocks/cosine.toml: is not in the list of blocks/CMakeLists.txt"
  "src/machines/ec-1.toml: is not in the list of src/machines/CMakeLists.txt"
  "notes.txt: does not belong at the top level"
  ".hidden: does not belong at the top level")
