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
plant(src/oblique/diagram/a.h "")
plant(src/oblique/diagram/a.cpp "#include <oblique/text/a.h>\nstd::snprintf(text)")
plant(src/oblique/patch/a.cpp "add_block(name, \"sine\", {})\nif (parameter.name == \"sine\" || definition.symbol == \"sine\") return")
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
plant(src/oblique/diagram/b.cpp "")
plant(src/oblique/network/a.cpp "if (block.definition->name == \"sine\") return")
plant(src/oblique/network/b.cpp "if (\"sine\" != type) return")
plant(src/oblique/machine/a.cpp "library.find(\"sine\")")
plant(src/oblique/machine/b.cpp "kRoles{{\"sine\", Role::other}}")
plant(src/oblique/solve/b.cpp "namespace oblique {\n\"end it with --until\"")
plant(src/oblique/solve/c.cpp "namespace oblique::text {\n\"see oblique check\"")
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
  "src/oblique/mechanism/a.cpp: stage 'mechanism' may not know stage 'diagram'"
  "src/oblique/mechanism/a.cpp: includes begin with oblique/, not with ../"
  "src/oblique/cellar/a.cpp: there is no stage 'cellar'"
  "src/oblique/diagram/b.cpp: a unit is a header and a source of one name; expected src/oblique/diagram/b.h"
  "src/oblique/network/a.cpp: no stage knows a block by its name"
  "src/oblique/network/b.cpp: no stage knows a block by its name"
  "src/oblique/machine/a.cpp: no stage knows a block by its name"
  "src/oblique/machine/b.cpp: no stage knows a block by its name"
  "src/oblique/solve/b.cpp: its namespace is oblique::solve"
  "src/oblique/solve/b.cpp: no stage spells an option or a verb"
  "src/oblique/solve/c.cpp: its namespace is oblique::solve"
  "src/oblique/solve/c.cpp: no stage spells an option or a verb"
  "src/cli: more than 32 units"
  "blocks/servo.toml: cites a file that no reader has"
  "src/oblique/solve/a.cpp: the library never prints and never exits"
  "blocks/cosine.toml: is not in the list of blocks/CMakeLists.txt"
  "src/machines/ec-1.toml: is not in the list of src/machines/CMakeLists.txt"
  "notes.txt: does not belong at the top level"
  ".hidden: does not belong at the top level")
