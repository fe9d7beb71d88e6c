# Installs the built tree, then configures, builds and runs consumer/ against what was installed.
# cmake -D BUILD=<built tree> -D WORK=<scratch directory> -P run.cmake
function(run)
    execute_process(COMMAND ${ARGV} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
    if(NOT code EQUAL 0)
        string(REPLACE ";" " " command "${ARGV}")
        message(FATAL_ERROR "${command}\nexit code ${code}\n${out}")
    endif()
    set(out "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)

# What is installed must not lead back into the tree that it was built from.
get_filename_component(source ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
file(GLOB_RECURSE package_files ${WORK}/prefix/*.cmake)
foreach(file ${package_files})
    file(READ ${file} text)
    foreach(path ${source}/ ${BUILD}/)
        string(REPLACE ${WORK} "" text "${text}")
        string(FIND "${text}" ${path} position)
        if(NOT position EQUAL -1)
            message(FATAL_ERROR "${file} contains the path ${path}")
        endif()
    endforeach()
endforeach()

# Moved once: a prefix has to work wherever it is.
file(RENAME ${WORK}/prefix ${WORK}/moved)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK}/consumer -G Ninja
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${WORK}/moved)
run(${CMAKE_COMMAND} --build ${WORK}/consumer)
run(${WORK}/consumer/consumer)
message(STATUS "${out}")
