# Target cdem_version writes include/cdem_config.h in the build folder; this file is also the script that it runs.
if(CMAKE_SCRIPT_MODE_FILE)
  execute_process(COMMAND git describe --tags --always --dirty WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE GIT OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
  if(failed)
    set(GIT "unknown")
  endif()
  configure_file(${SOURCE}/cmake/cdem_config.h.in ${OUTPUT} @ONLY) # rewritten only when it differs
  return()
endif()

add_custom_target(cdem_version
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${CMAKE_SOURCE_DIR} -DOUTPUT=${CMAKE_BINARY_DIR}/include/cdem_config.h
    -DVERSION=${PROJECT_VERSION} -DMARCH=${CDEM_MARCH} -DBUILD_TYPE=${CMAKE_BUILD_TYPE} -DCONTRACT=${CDEM_CONTRACT}
    "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}" -P ${CMAKE_CURRENT_LIST_FILE}
  BYPRODUCTS ${CMAKE_BINARY_DIR}/include/cdem_config.h
  COMMENT "" VERBATIM)
