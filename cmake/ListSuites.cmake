# Writes to LISTING one ctest entry for every suite of the GoogleTest program PROGRAM. Instances of a parameterised or
# typed suite ("All/SamplerTest", "LaneTest/0") share the entry of their suite. Suites named Long* get the label `long`,
# which ./test.sh leaves out unless it is told --all.

execute_process(COMMAND ${CMAKE_COMMAND} -E env ${ENVIRONMENT} "${PROGRAM}" --gtest_list_tests
    OUTPUT_VARIABLE output RESULT_VARIABLE status)
if(NOT status EQUAL 0)
    file(REMOVE "${LISTING}")
    message(FATAL_ERROR "${PROGRAM} --gtest_list_tests ended with ${status}")
endif()

string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\." lines "${output}")
set(suites)
foreach(line IN LISTS lines)
    string(STRIP "${line}" line)
    string(REGEX REPLACE "(/[0-9]+)?\\.$" "" suite "${line}")
    string(REGEX REPLACE "^.*/" "" suite "${suite}")
    list(APPEND suites ${suite})
    list(APPEND filter_${suite} "${line}*")
endforeach()
list(REMOVE_DUPLICATES suites)

set(text "")
foreach(suite IN LISTS suites)
    list(JOIN filter_${suite} ":" filter)
    set(properties "TIMEOUT 300")
    if(suite MATCHES "^(DISABLED_)?Long")
        set(properties "TIMEOUT 3600 LABELS long")
    endif()
    if(ENVIRONMENT)
        string(APPEND properties " ENVIRONMENT [==[${ENVIRONMENT}]==]")
    endif()
    string(APPEND text
        "add_test([==[${suite}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${filter}]==])\n"
        "set_tests_properties([==[${suite}]==] PROPERTIES ${properties})\n")
endforeach()
file(WRITE "${LISTING}" "${text}")
