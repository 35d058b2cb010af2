# Builds the fuzz target NAME of the project in SOURCE_DIR and runs it for SECONDS. What it finds stays in build/fuzz, as
# NAME-crash-... and so on; the corpus that it gathers stays there, too, in corpus/NAME.

set(build "${SOURCE_DIR}/build/fuzz")
set(corpus "${build}/corpus/${NAME}")
file(MAKE_DIRECTORY "${corpus}")

find_program(CLANG NAMES clang++ clang++-19 clang++-18 clang++-17 clang++-16 clang++-15 clang++-14)
file(WRITE "${build}/probe.cpp" "extern \"C\" int LLVMFuzzerTestOneInput(const char*, decltype(sizeof 0)) { return 0; }\n")
set(status "not found")
if(CLANG)
    execute_process(COMMAND "${CLANG}" -fsanitize=fuzzer,address "${build}/probe.cpp" -o "${build}/probe"
        RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
endif()
if(NOT status EQUAL 0)
    message("fuzz: skipped: clang++ with libFuzzer is not installed (Debian: clang, libclang-rt-*-dev)")
    return()
endif()

function(run)
    execute_process(COMMAND ${ARGN} WORKING_DIRECTORY "${SOURCE_DIR}" RESULT_VARIABLE status)
    if(NOT status EQUAL 0)
        message(FATAL_ERROR "${ARGN} ended with ${status}")
    endif()
endfunction()

run("${CMAKE_COMMAND}" --preset fuzz "-DCMAKE_CXX_COMPILER=${CLANG}")
run("${CMAKE_COMMAND}" --build --preset fuzz --target fuzz_${NAME})

set(dictionary)
if(EXISTS "${SOURCE_DIR}/tests/fuzz/${NAME}.dict")
    set(dictionary "-dict=${SOURCE_DIR}/tests/fuzz/${NAME}.dict")
endif()
set(seeds "${SOURCE_DIR}/tests/fuzz/seeds/${NAME}")
if(NAME STREQUAL "scene")
    list(APPEND seeds "${SOURCE_DIR}/scenes/gallery")
endif()
run("${build}/fuzz_${NAME}" -max_total_time=${SECONDS} -timeout=30 -rss_limit_mb=2048 -max_len=16384 -use_value_profile=1
    ${dictionary} "-artifact_prefix=${build}/${NAME}-" -print_final_stats=1 "${corpus}" ${seeds})
