# What nearly every test includes, parsed once for all of them. A compiler takes it only where the options are the same, so
# those of add_module_test stand here too.
add_custom_target(release_tests)
function(add_test_headers)
  file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cc CONTENT "int main() {}\n")
  add_executable(test_headers ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cc)
  target_link_libraries(test_headers PRIVATE footing_warnings GTest::gmock Eigen3::Eigen)
  target_compile_options(test_headers PRIVATE -O0 ${TEST_HEADER_OPTIONS})
  target_compile_definitions(test_headers PRIVATE FOOTING_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                             FOOTING_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_precompile_headers(test_headers PRIVATE <gmock/gmock.h> <gtest/gtest.h> <Eigen/Dense> <algorithm> <array> <cmath>
                            <functional> <map> <memory> <optional> <string> <vector>)
endfunction()
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  set(TEST_HEADER_OPTIONS -fpch-preprocess)  # Lets ccache see what was parsed.
endif()

# The one rule for limits of wall time: they guard against hangs and nothing else. A limit is ten times what the test takes
# alone on a quiet machine with two cores, thrice that with sanitizers, and at least five minutes. A test that takes over half a
# minute states its time: set_quiet_time(<seconds> <test>...), or QUIET_S of add_module_test. No other place sets a TIMEOUT.
set(QUIET_S_OF_MOST 30)
function(limit_of_quiet_time quiet_s out)
  set(factor 10)
  if(FOOTING_SANITIZE)
    set(factor 30)
  endif()
  if(quiet_s LESS QUIET_S_OF_MOST)
    set(quiet_s ${QUIET_S_OF_MOST})
  endif()
  math(EXPR limit_s "${factor} * ${quiet_s}")
  set(${out} ${limit_s} PARENT_SCOPE)
endfunction()
function(set_quiet_time quiet_s)
  limit_of_quiet_time(${quiet_s} limit_s)
  set_tests_properties(${ARGN} PROPERTIES TIMEOUT ${limit_s})
endfunction()
# Listing the cases of a program takes a moment, but its limit of 5 s cuts it on a loaded machine.
set(DISCOVERY_LIMIT_S 120)

# What a build with sanitizers leaves out of a program, as GoogleTest's filter, or the word "all".
set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/release_only.txt)
file(STRINGS ${PROJECT_SOURCE_DIR}/tests/release_only.txt RELEASE_ONLY_CASES REGEX "^[^#]")
function(release_only_of name out)
  set(left_out "")
  foreach(case IN LISTS RELEASE_ONLY_CASES)
    if(case STREQUAL name)
      set(left_out all)
      break()
    elseif(case MATCHES "^${name}[.](.+)$")
      list(APPEND left_out ${CMAKE_MATCH_1})
    endif()
  endforeach()
  list(JOIN left_out ":" left_out)
  set(${out} "${left_out}" PARENT_SCOPE)
endfunction()

function(_add_cases name program filter labels limit_s quiet_s)
  add_test(NAME ${name} COMMAND ${program} --gtest_brief=1
           --gtest_output=xml:${PROJECT_BINARY_DIR}/tests/results/${name}.xml ${filter})
  # What takes longest begins first.
  set_tests_properties(${name} PROPERTIES ENVIRONMENT "FOOTING_TEST_DATA=${FOOTING_TEST_DATA}" TIMEOUT ${limit_s} COST ${quiet_s})
  set_property(TEST ${name} PROPERTY LABELS ${labels})
endfunction()

# scripts/test runs each test once. Label sanitized: with sanitizers, so that its program is not compiled for the release run;
# no_sanitizer: in the release build, whose target release_tests makes its program; neither: in both.

# add_module_test(<name> SOURCES ... [DEPS ...] [LABELS ...] [QUIET_S seconds]): one GoogleTest program and one CTest test, whose
# cases share a process. Its cases are counted from the XML that it writes (scripts/summarise-tests). The cases that
# tests/release_only.txt names are a second test of the release build, <name>.release_only.
function(add_module_test name)
  cmake_parse_arguments(arg "" "QUIET_S" "SOURCES;DEPS;LABELS" ${ARGN})
  if(FOOTING_SANITIZE AND arg_LABELS MATCHES "long")
    return()  # Never run with sanitizers.
  endif()
  release_only_of(${name} release_only)
  if(FOOTING_SANITIZE AND release_only STREQUAL "all")
    return()
  elseif(release_only STREQUAL "all")
    list(APPEND arg_LABELS no_sanitizer)
    set(release_only "")
  elseif(NOT arg_LABELS MATCHES "long|no_sanitizer")
    list(APPEND arg_LABELS sanitized)
  endif()
  if(NOT arg_QUIET_S)
    set(arg_QUIET_S ${QUIET_S_OF_MOST})
  endif()
  limit_of_quiet_time(${arg_QUIET_S} limit_s)
  set(links "")
  foreach(dep IN LISTS arg_DEPS)
    if(DEFINED EXTERNAL_${dep})
      list(APPEND links ${EXTERNAL_${dep}})
    else()
      list(APPEND links ${dep})
    endif()
  endforeach()
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${links} footing_warnings GTest::gmock GTest::gtest_main)
  # Test code is compiled far more often than it runs.
  target_compile_options(${name} PRIVATE -O0 ${TEST_HEADER_OPTIONS})
  target_compile_definitions(${name} PRIVATE FOOTING_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                             FOOTING_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_precompile_headers(${name} REUSE_FROM test_headers)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  if(arg_LABELS MATCHES "no_sanitizer" OR (release_only AND NOT FOOTING_SANITIZE))
    add_dependencies(release_tests ${name})
  endif()
  set(cases "")
  if(release_only)
    set(cases --gtest_filter=-${release_only})
  endif()
  _add_cases(${name} ${name} "${cases}" "${arg_LABELS}" ${limit_s} ${arg_QUIET_S})
  if(release_only AND NOT FOOTING_SANITIZE)
    _add_cases(${name}.release_only ${name} --gtest_filter=${release_only} no_sanitizer ${limit_s} ${arg_QUIET_S})
  endif()
endfunction()
