# Installs the build in BINARY_DIR into a fresh prefix, runs the program there, which must find its module, builds the
# program in CONSUMER against the package, and lets that render SCENE.

function(run)
    execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE status)
    if(NOT status EQUAL 0)
        message(FATAL_ERROR "${ARGN} ended with ${status}:\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

set(folder "${BINARY_DIR}/installed_package")
file(REMOVE_RECURSE "${folder}")
run("${CMAKE_COMMAND}" --install "${BINARY_DIR}" --prefix "${folder}/prefix")
run("${folder}/prefix/${BINDIR}/penumbra" --version)
if(NOT output MATCHES "OpenImageIO [0-9]")
    message(FATAL_ERROR "the installed program printed: ${output}")
endif()
run("${CMAKE_COMMAND}" -S "${CONSUMER}" -B "${folder}/build" -G "${GENERATOR}" "-DCMAKE_CXX_COMPILER=${COMPILER}"
    "-DCMAKE_PREFIX_PATH=${folder}/prefix" "-DPENUMBRA_VERSION=${VERSION}" "-DPENUMBRA_HEADERS=${HEADERS}")
run("${CMAKE_COMMAND}" --build "${folder}/build")
run("${folder}/build/consumer" "${SCENE}" "${folder}/picture.png")
if(NOT output MATCHES "^Penumbra ${VERSION}: mean 0[.][0-9]+\n$" OR NOT EXISTS "${folder}/picture.png")
    message(FATAL_ERROR "the consumer printed: ${output}")
endif()
file(REMOVE_RECURSE "${folder}")
