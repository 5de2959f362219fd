# contributed_firn: the program as it is once someone has followed "Add a stage" in CONTRIBUTING.md. Every file that the text shows is
# laid into a folder of its own, and a copy of stages/register.cpp gets the two lines; all else is the program's own.
set(contributed ${CMAKE_CURRENT_BINARY_DIR}/contributed)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md ${PROJECT_SOURCE_DIR}/stages/register.cpp)
file(READ ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md text)
string(FIND "${text}" "## Add a stage" begin)
string(SUBSTRING "${text}" ${begin} -1 text)

set(shown)
foreach(pattern "stages/[a-z_/]+\\.h" "stages/[a-z_/]+\\.cpp" "shaders/[a-z_/]+\\.comp")
  # A path at the head of a point, and the block that belongs to it.
  if(NOT "${text}" MATCHES "\n[0-9]\\. `(${pattern})`[^\n]*\n[^0-9][^`]*(`[^`]+`[^`]+)*```[a-z]+\n([^`]*)\n   ```")
    message(FATAL_ERROR "CONTRIBUTING.md shows no file ${pattern} under 'Add a stage'")
  endif()
  set(path ${CMAKE_MATCH_1})
  string(REGEX REPLACE "(^|\n)   " "\\1" block "${CMAKE_MATCH_3}")
  file(CONFIGURE OUTPUT ${contributed}/${path} CONTENT "${block}\n" @ONLY)
  list(APPEND shown ${path})
endforeach()

if(NOT "${text}" MATCHES "`(#include \"stages/[^`]*)` and `(registry\\.add[^`]*)`")
  message(FATAL_ERROR "CONTRIBUTING.md names no lines for stages/register.cpp")
endif()
set(include_line "${CMAKE_MATCH_1}")
set(add_line "${CMAKE_MATCH_2}")
file(READ ${PROJECT_SOURCE_DIR}/stages/register.cpp list)
string(REPLACE "#include \"stages/register.h\"\n" "#include \"stages/register.h\"\n\n${include_line}\n" list "${list}")
string(REPLACE "  return registry;\n" "  ${add_line}\n  return registry;\n" list "${list}")
file(CONFIGURE OUTPUT ${contributed}/stages/register.cpp CONTENT "${list}" @ONLY)

list(FILTER shown INCLUDE REGEX "\\.cpp$")
list(TRANSFORM shown PREPEND ${contributed}/)
add_executable(contributed_firn ${PROJECT_SOURCE_DIR}/app/main.cpp ${contributed}/stages/register.cpp ${shown})
target_include_directories(contributed_firn PRIVATE ${contributed})
target_link_libraries(contributed_firn PRIVATE firn_app)
firn_options(contributed_firn)
