# generate_messages(structs|conversions OUT <variable> FILES...): the plain structs of messages or their
# conversions, which proto/generate_structs.py writes out of proto/footing/v1 and proto/structs.toml. FILES
# are what it writes, relative to ${PROJECT_BINARY_DIR}/generated, which is where includes find them.
find_program(FOOTING_GENERATOR_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH
             DOC "A Python 3.11 or later with google.protobuf, for proto/generate_structs.py")
execute_process(COMMAND ${FOOTING_GENERATOR_PYTHON} -c "import tomllib, google.protobuf"
                RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
if(failed)
  message(FATAL_ERROR "no Python 3.11 with google.protobuf: install python3-protobuf, or set FOOTING_GENERATOR_PYTHON")
endif()

function(generate_messages which)
  cmake_parse_arguments(arg "" "OUT" "" ${ARGN})
  set(proto ${PROJECT_SOURCE_DIR}/proto)
  set(root ${PROJECT_BINARY_DIR}/generated)
  list(TRANSFORM FOOTING_PROTOS PREPEND ${proto}/footing/v1/ OUTPUT_VARIABLE protos)
  list(TRANSFORM protos APPEND .proto)
  list(TRANSFORM arg_UNPARSED_ARGUMENTS PREPEND ${root}/ OUTPUT_VARIABLE files)
  add_custom_command(
    OUTPUT ${files}
    COMMAND ${FOOTING_GENERATOR_PYTHON} ${proto}/generate_structs.py ${which} ${root} ${proto}/structs.toml
            $<TARGET_FILE:protobuf::protoc> ${protos}
    DEPENDS ${proto}/generate_structs.py ${proto}/structs.toml ${protos}
    COMMENT "${which} of messages" VERBATIM)
  set(${arg_OUT} ${files} PARENT_SCOPE)
endfunction()
