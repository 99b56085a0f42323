// Entry of tests that elaborate SystemC modules. libsystemc has the main(); SystemC's error and warning
// reports fail the test.
#include <gtest/gtest.h>

#include <cstdlib>
#include <systemc>

namespace {

/// SystemC prints its banner before sc_main().
const bool banner_off = [] {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 1);
    return true;
}();

void fail_on_report(const sc_core::sc_report& report, const sc_core::sc_actions& actions) {
    if (report.get_severity() >= sc_core::SC_WARNING) ADD_FAILURE() << "SystemC: " << report.what();
    sc_core::sc_report_handler::default_handler(report, actions);
}

}  // namespace

int sc_main(int argc, char** argv) {
    (void)banner_off;
    ::testing::InitGoogleTest(&argc, argv);
    sc_core::sc_report_handler::set_handler(fail_on_report);
    return RUN_ALL_TESTS();
}
