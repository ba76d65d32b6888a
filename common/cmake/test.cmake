# add_module_test(<name> SOURCES ... [DEPS ...] [LABELS ...] [TIMEOUT seconds]): one GoogleTest program; every case becomes one
# CTest test. Cases that call GTEST_SKIP show as skipped.
function(add_module_test name)
  cmake_parse_arguments(arg "" "TIMEOUT" "SOURCES;DEPS;LABELS" ${ARGN})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
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
  target_compile_options(${name} PRIVATE -O0)
  target_compile_definitions(${name} PRIVATE FOOTING_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                             FOOTING_BINARY_DIR="${PROJECT_BINARY_DIR}")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  set(properties ENVIRONMENT "FOOTING_TEST_DATA=${FOOTING_TEST_DATA}" TIMEOUT ${arg_TIMEOUT})
  if(arg_LABELS)
    list(APPEND properties LABELS "${arg_LABELS}")
  endif()
  gtest_discover_tests(${name} TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST
                       PROPERTIES ${properties})
endfunction()
