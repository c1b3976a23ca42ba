//! Machines without a Vulkan loader, without a driver, without the requested device. Unit tests of
//! device selection cover devices that lack a feature.

use super::Case;

const NO_LOADER: [(&str, &str); 1] = [("MOIRE_VULKAN_LIBRARY", "/nonexistent/libvulkan.so.1")];
const NO_DRIVER: [(&str, &str); 2] =
    [("VK_DRIVER_FILES", "/nonexistent/icd.json"), ("VK_ICD_FILENAMES", "/nonexistent/icd.json")];

#[test]
fn without_a_loader_the_message_says_what_to_install() {
    let case = Case::new();
    let wanted = ["no Vulkan loader", "/nonexistent/libvulkan.so.1", "setup.sh", "libvulkan1"];
    case.fails(&NO_LOADER, &["devices"], &wanted);
    case.fails(&NO_LOADER, &["render", "scene.toml", "-o", "out.png"], &wanted);
}

#[test]
fn without_a_device_the_message_says_what_to_install_and_nothing_else_renders_instead() {
    let case = Case::new();
    let wanted = ["no Vulkan device", "setup.sh", "mesa-vulkan-drivers"];
    case.fails(&NO_DRIVER, &["devices"], &wanted);
    for select in [&[][..], &["--device", "cpu"], &["--device", "0"]] {
        case.fails(&NO_DRIVER, &[&["render", "scene.toml", "-o", "out.png"], select].concat(), &wanted);
    }
}

#[test]
fn the_oracle_needs_neither_loader_nor_device() {
    let case = Case::new();
    let args = ["render", "scene.toml", "-q", "-o", "new.png", "--device", "oracle"];
    assert_eq!(case.run(&NO_LOADER, &args).0, Some(0));
    assert!(case.path("new.png").is_file());
}

#[test]
fn a_device_that_is_not_here_is_refused_with_the_list_of_those_that_are() {
    let case = Case::new();
    for select in ["99", "voodoo"] {
        let args = ["render", "scene.toml", "-o", "out.png", "--device", select];
        case.fails(&[], &args, &["no Vulkan device", select, "Devices here"]);
    }
    case.fails(&[], &["render", "scene.toml", "-o", "out.png", "--device", ""], &["device"]);
}
