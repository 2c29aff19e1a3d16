# SPDX-License-Identifier: MIT
# Installs BUILD into a folder of its own below WORK, then configures, builds and runs the project SOURCE against it.
cmake_minimum_required(VERSION 3.25)
set(prefix ${WORK}/prefix)
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_PREFIX_PATH=${prefix} -DPAGE=${PAGE} -DDIAGRAMS=${DIAGRAMS})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/stage_consumer)
run(${CMAKE_COMMAND} --build ${WORK}/build --target run_examples)
