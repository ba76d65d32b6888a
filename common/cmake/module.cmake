# add_module(<name> [PURE] HEADERS ... SOURCES ... [GENERATED ...] [DEPS ...] [PRIVATE_DEPS ...])
#
# GENERATED are files of generate_messages() (common/cmake/messages.cmake).
# One folder = one module = one static library. A module may name only modules declared above it,
# so the order of add_subdirectory() is the layering, and cycles cannot be written. DEPS also names
# external libraries by their short names (see common/cmake/external.cmake); a pure module may name
# only the pure ones.
# A folder daemon/sensor/... never names daemon/simulation/... or the other way round, a client
# names common and itself, never another client; daemon/offline alone may name both daemons.
# Synthetic people and devices (common/virtual) are for clients, daemon/offline and tests: never in
# what footingd and footing-sim are made of.
define_property(TARGET PROPERTY MODULE_FOLDER)
define_property(TARGET PROPERTY MODULE_PURE)

function(_check_side name folder dep_folder)
  set(allowed "^common(/|$)|^proto(/|$)")
  if(folder MATCHES "^daemon/sensor/")
    string(APPEND allowed "|^daemon/sensor/")
  elseif(folder MATCHES "^daemon/simulation/")
    string(APPEND allowed "|^daemon/simulation/")
  elseif(folder MATCHES "^daemon/offline/")
    string(APPEND allowed "|^daemon/")
  elseif(folder MATCHES "^(clients/[^/]+)")
    string(APPEND allowed "|^${CMAKE_MATCH_1}(/|$)")
  endif()
  if(NOT dep_folder MATCHES "${allowed}")
    message(FATAL_ERROR "${name} in ${folder} may not name a module of ${dep_folder}")
  endif()
  if(dep_folder MATCHES "^common/virtual/"
     AND NOT folder MATCHES "^(common/virtual|daemon/offline|clients|tests)/")
    message(FATAL_ERROR "${name} in ${folder} may not name ${dep_folder}: no daemon contains synthetic "
                        "people or devices; move what is shared out of common/virtual")
  endif()
endfunction()

function(_resolve_deps name folder pure out_links)
  set(links "")
  foreach(dep IN LISTS ARGN)
    if(TARGET ${dep})
      get_target_property(dep_folder ${dep} MODULE_FOLDER)
    else()
      set(dep_folder "")
    endif()
    if(dep_folder)
      _check_side(${name} ${folder} ${dep_folder})
      get_target_property(dep_pure ${dep} MODULE_PURE)
      if(pure AND NOT dep_pure)
        message(FATAL_ERROR "pure module ${name} may not depend on ${dep}, which does I/O")
      endif()
      list(APPEND links ${dep})
    elseif(DEFINED EXTERNAL_${dep})
      if(pure AND NOT dep IN_LIST EXTERNAL_PURE)
        message(FATAL_ERROR "pure module ${name} may not depend on the external library ${dep}")
      endif()
      list(APPEND links ${EXTERNAL_${dep}})
    else()
      message(FATAL_ERROR "${name} names ${dep}, which is not declared above it")
    endif()
  endforeach()
  set(${out_links} ${links} PARENT_SCOPE)
endfunction()

function(add_module name)
  cmake_parse_arguments(arg "PURE" "" "HEADERS;SOURCES;GENERATED;DEPS;PRIVATE_DEPS" ${ARGN})
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "add_module(${name}): unknown arguments ${arg_UNPARSED_ARGUMENTS}")
  endif()
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  _resolve_deps(${name} ${folder} "${arg_PURE}" public_links ${arg_DEPS})
  _resolve_deps(${name} ${folder} "${arg_PURE}" private_links ${arg_PRIVATE_DEPS})

  if(arg_SOURCES)
    add_library(${name} STATIC ${arg_SOURCES})
    set(scope PUBLIC)
  else()
    add_library(${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  # A header that a source of its name includes first has been compiled alone there (check_includes.py sees to the order); only
  # the others need it done for them.
  set(with_source "")
  set(without_source ${arg_HEADERS})
  string(REPLACE ".cc" ".h" sourced "${arg_SOURCES}")
  foreach(header IN LISTS arg_HEADERS)
    if(header IN_LIST sourced)
      list(APPEND with_source ${header})
      list(REMOVE_ITEM without_source ${header})
    endif()
  endforeach()
  target_sources(${name} ${scope}
                 FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${with_source}
                 FILE_SET without_source TYPE HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${without_source})
  if(arg_GENERATED)
    set(headers ${arg_GENERATED})
    list(FILTER headers INCLUDE REGEX "\\.h$")
    list(REMOVE_ITEM arg_GENERATED ${headers})
    target_sources(${name} PRIVATE ${arg_GENERATED}
                   PUBLIC FILE_SET generated TYPE HEADERS BASE_DIRS ${PROJECT_BINARY_DIR}/generated FILES ${headers})
  endif()
  target_link_libraries(${name} ${scope} ${public_links})
  # The fuzzer follows what decodes; the rest runs as fast as in any build with sanitizers.
  if(folder MATCHES "^(common|daemon/sensor|clients/relay|clients/skeleton|clients/stream|clients/web)(/|$)")
    if(FOOTING_FUZZ AND arg_SOURCES)
      target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link)
    endif()
  elseif(FOOTING_SANITIZE AND arg_SOURCES AND NOT arg_PURE)
    # What mostly waits is compiled in half the time.
    target_compile_options(${name} PRIVATE -O0)
  endif()
  if(arg_SOURCES)
    target_link_libraries(${name} PRIVATE ${private_links} footing_warnings)
  endif()
  set_target_properties(${name} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON
                        INTERFACE_HEADER_SETS_TO_VERIFY without_source
                        MODULE_FOLDER "${folder}" MODULE_PURE "${arg_PURE}")

  string(REPLACE ";" " " public "${arg_DEPS}")
  string(REPLACE ";" " " private "${arg_PRIVATE_DEPS}")
  set_property(GLOBAL APPEND_STRING PROPERTY MODULE_TABLE
               "${name}|${folder}|${arg_PURE}|${public}|${private}\n")
endfunction()

# add_program(<name> [RELEASE_ONLY] SOURCES main.cc DEPS ...): an executable in build/<preset>/bin. Its
# folder's files are checked like those of a module. RELEASE_ONLY: no part of a build with sanitizers,
# whose tests of the modules it calls are enough; ask for it by name.
function(add_program name)
  cmake_parse_arguments(arg "RELEASE_ONLY" "" "SOURCES;DEPS" ${ARGN})
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  _resolve_deps(${name} ${folder} "" links ${arg_DEPS})
  add_executable(${name} ${arg_SOURCES})
  if(arg_RELEASE_ONLY AND FOOTING_SANITIZE)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
  if(NOT TARGET programs)
    add_custom_target(programs)
  endif()
  add_dependencies(programs ${name})
  target_link_libraries(${name} PRIVATE ${links} footing_warnings)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  install(TARGETS ${name} RUNTIME DESTINATION bin COMPONENT ${name})
  # Its manual page is what it says with --help.
  install(CODE "
    execute_process(COMMAND \"${Python3_EXECUTABLE}\" \"${PROJECT_SOURCE_DIR}/common/cmake/man_page.py\"
                            \"$<TARGET_FILE:${name}>\" \"${PROJECT_VERSION}\"
                            \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}\"
                    COMMAND_ERROR_IS_FATAL ANY)"
    COMPONENT ${name})
  # Completion is one file, found by the name of the program.
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/bash-completion/completions\")
    file(MAKE_DIRECTORY \"\${folder}\")
    file(CREATE_LINK footing \"\${folder}/${name}\" SYMBOLIC)
    message(STATUS \"Installing: \${folder}/${name}\")"
    COMPONENT ${name})
  string(REPLACE ";" " " deps "${arg_DEPS}")
  set_property(GLOBAL APPEND_STRING PROPERTY MODULE_TABLE "${name}|${folder}|FALSE|${deps}|\n")
endfunction()

# Writes the table that tests/architecture/check_includes.py reads.
function(write_module_table path)
  get_property(table GLOBAL PROPERTY MODULE_TABLE)
  file(WRITE ${path} "${table}")
endfunction()
