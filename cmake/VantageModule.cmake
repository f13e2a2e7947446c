# SPDX-License-Identifier: Apache-2.0
# vantage_module(NAME SOURCES a.cpp b.cpp DEPENDS base geometry LIBRARIES TBB::tbb)
#   One library a folder. Its sources are listed, its tests are every *_test.cpp beside them (one program a module).

add_library(vantage_flags INTERFACE)
target_compile_features(vantage_flags INTERFACE cxx_std_20)
# Same bits everywhere: no contraction into fused operations, no fast-math, no -march.
target_compile_options(vantage_flags INTERFACE -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
target_include_directories(vantage_flags INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_include_directories(vantage_flags SYSTEM INTERFACE $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>)
target_compile_definitions(vantage_flags INTERFACE VANTAGE_VERSION="${PROJECT_VERSION}")

# Heavy standard headers and Eigen, parsed once.
add_library(vantage_pch STATIC ${PROJECT_SOURCE_DIR}/cmake/pch.cpp)
target_link_libraries(vantage_pch PRIVATE vantage_flags)
target_precompile_headers(vantage_pch PRIVATE <Eigen/Core> <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory> <optional> <span> <string> <variant> <vector>)

# The shared header for a program too: compiled as the libraries are, or the compiler refuses it.
function(vantage_use_pch program)
  set_target_properties(${program} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_compile_options(${program} PRIVATE -fPIC)
  target_precompile_headers(${program} REUSE_FROM vantage_pch)
endfunction()

function(vantage_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;LIBRARIES" ${ARGN})
  add_library(vantage_${name} STATIC ${ARG_SOURCES})
  target_link_libraries(vantage_${name} PUBLIC vantage_flags PRIVATE ${ARG_LIBRARIES})
  foreach(dependency IN LISTS ARG_DEPENDS)
    target_link_libraries(vantage_${name} PUBLIC vantage_${dependency})
  endforeach()
  target_precompile_headers(vantage_${name} REUSE_FROM vantage_pch)
  set_property(GLOBAL APPEND PROPERTY VANTAGE_MODULES vantage_${name})

  file(GLOB tests CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp)
  if(VANTAGE_TESTS AND tests)
    vantage_test(${name} SOURCES ${tests} LIBRARIES vantage_${name} ${ARG_LIBRARIES})
  endif()
endfunction()

# vantage_test(NAME SOURCES a_test.cpp LIBRARIES vantage_base): one GoogleTest program, its tests named NAME.Suite.Test and run from the root.
function(vantage_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name}_test ${ARG_SOURCES})
  target_link_libraries(${name}_test PRIVATE ${ARG_LIBRARIES} GTest::gtest_main rapidcheck)
  vantage_use_pch(${name}_test)
  gtest_discover_tests(${name}_test TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60 WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
endfunction()
