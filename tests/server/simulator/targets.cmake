# qtet_simulator: the server's sessions on a simulated kernel (SIMULATOR.md).
file(GLOB simulator_sources CONFIGURE_DEPENDS server/simulator/*.cpp)
set(not_by_default)
if(NOT QTET_UNIT_TESTS)
  set(not_by_default EXCLUDE_FROM_ALL)  # for long runs, at the speed of a release
endif()
add_executable(qtet_simulator ${not_by_default} ${simulator_sources}
  server/store/synthetic_log.cpp support/allocation_meter.cpp)
target_link_libraries(qtet_simulator PRIVATE qtet::server spdlog::spdlog)
# All references to these become references to __wrap_NAME (system_calls.cpp).
foreach(name IN ITEMS epoll_create1 epoll_ctl epoll_wait timerfd_create close recv __recv_chk
    sendmsg sendfile setsockopt getsockopt getpeername shutdown ioctl clock_gettime time
    _ZNSt6chrono3_V212steady_clock3nowEv _ZNSt6chrono3_V212system_clock3nowEv)
  target_link_options(qtet_simulator PRIVATE LINKER:--wrap=${name})
endforeach()
set_target_properties(qtet_simulator PROPERTIES
  RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
if(QTET_UNIT_TESTS)
  add_test(NAME simulator.seeds COMMAND qtet_simulator --count 200 --jobs 2)
  add_test(NAME simulator.again COMMAND qtet_simulator --first 1000 --count 4 --twice)
  set_tests_properties(simulator.seeds simulator.again PROPERTIES LABELS server TIMEOUT ${hangs})
  set_tests_properties(simulator.seeds PROPERTIES PROCESSORS 2)
  add_dependencies(check_server qtet_simulator)
endif()
