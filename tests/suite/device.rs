//! The device layer on a real driver (`MOIRE_DEVICE`, else `cpu`): uploads are read back unchanged,
//! shaders read the resources that are bound, and the validation layer, if installed, reports
//! nothing unless a mistake is planted.

mod copies;
mod images;
mod pipelines;
mod refused;
mod solids;

use moire::internal::gpu::{
    BindingDesc, BindingKind, Bound, Buffer, BufferUse, DeviceSelect, Gpu, MessageLog, OpenOptions, Pipeline,
    PipelineDesc, list_devices, validation_available,
};

use crate::device_shaders::FILL;
use crate::support::untested;

/// An open device whose validation messages fail the test, also those of its closing.
struct Checked {
    gpu: Option<Gpu>,
    log: MessageLog,
}

impl Checked {
    fn open() -> Checked {
        let name = std::env::var("MOIRE_DEVICE").unwrap_or_else(|_| "cpu".into());
        let select = DeviceSelect::parse(&name).unwrap();
        let gpu = Gpu::open_with(&select, OpenOptions { validation: true }).unwrap();
        assert_eq!(gpu.validation_active(), validation_available());
        if !gpu.validation_active() {
            untested("what the validation layer would say: it is not installed");
        }
        let log = gpu.message_log();
        Checked { gpu: Some(gpu), log }
    }
}

impl std::ops::Deref for Checked {
    type Target = Gpu;

    fn deref(&self) -> &Gpu {
        self.gpu.as_ref().unwrap()
    }
}

impl Drop for Checked {
    fn drop(&mut self) {
        self.gpu = None;
        let messages = self.log.to_vec();
        if !std::thread::panicking() {
            assert!(messages.is_empty(), "validation: {messages:#?}");
        }
    }
}

fn one(binding: u32, kind: BindingKind) -> BindingDesc {
    BindingDesc { binding, kind, count: 1 }
}

fn fill(gpu: &Gpu, factor: u32) -> Pipeline {
    gpu.pipeline(&PipelineDesc {
        name: "fill",
        spirv: FILL,
        bindings: &[one(0, BindingKind::StorageBuffer)],
        push_constant_bytes: 8,
        constants: &[(7, factor)],
    })
    .unwrap()
}

fn bytes_of(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_ne_bytes()).collect()
}

fn read_u32(gpu: &Gpu, buffer: &Buffer) -> Vec<u32> {
    let mut bytes = vec![0; buffer.bytes() as usize];
    gpu.read_buffer(buffer, 0, &mut bytes).unwrap();
    bytes.chunks_exact(4).map(|c| u32::from_ne_bytes(c.try_into().unwrap())).collect()
}

fn noise(len: usize) -> Vec<u8> {
    (0..len as u32).map(|i| (i.wrapping_mul(0x9E37_79B9) >> 24) as u8).collect()
}

fn error_of<T>(result: moire::internal::core::error::Result<T>) -> String {
    result.err().expect("an error was expected").to_string()
}

#[test]
fn devices_are_listed_with_their_limits() {
    let devices = list_devices().unwrap();
    for (index, device) in devices.iter().enumerate() {
        assert_eq!(device.index, index);
        assert!(!device.name.is_empty() && !device.driver.is_empty());
        // Vulkan 1.2, "Limit Requirements".
        assert!(device.limits.max_image_2d >= 4096, "{device:?}");
        assert!(device.limits.max_push_constants >= 128, "{device:?}");
        assert!(device.limits.sub_texel_bits >= 4, "{device:?}");
        assert!(device.limits.heap_bytes > 0, "{device:?}");
    }
    let gpu = Checked::open();
    assert!(devices.iter().any(|device| device.uuid == gpu.info().uuid && device.name == gpu.info().name));
}

#[test]
fn buffers_come_back_as_uploaded_at_any_size() {
    let gpu = Checked::open();
    // Odd sizes, and more than one transfer chunk (16 MiB).
    for len in [1, 2, 3, 4, 5, 4095, 65_537, (16 << 20) + 12_345] {
        let data = noise(len);
        let buffer = gpu.upload_buffer("noise", BufferUse::Storage, &data).unwrap();
        let mut back = vec![0; len];
        gpu.read_buffer(&buffer, 0, &mut back).unwrap();
        assert!(back == data, "{len} bytes changed on the way");
        let tail = len.min(3);
        let mut back = vec![0; tail];
        gpu.read_buffer(&buffer, (len - tail) as u64, &mut back).unwrap();
        assert_eq!(back, data[len - tail..], "tail of {len} bytes");
    }
}

#[test]
fn parts_of_a_buffer_are_written() {
    let gpu = Checked::open();
    let buffer = gpu.upload_buffer("seven", BufferUse::Storage, &[9; 7]).unwrap();
    gpu.write_buffer(&buffer, 2, &[1, 2, 3]).unwrap();
    let mut back = [0; 7];
    gpu.read_buffer(&buffer, 0, &mut back).unwrap();
    assert_eq!(back, [9, 9, 1, 2, 3, 9, 9]);
    let error = error_of(gpu.read_buffer(&buffer, 5, &mut back[..3]));
    assert!(error.contains("`seven`"), "{error}");
    assert!(gpu.write_buffer(&buffer, u64::MAX, &[1]).is_err());
}

#[test]
fn a_dispatch_sees_push_constants_specialization_and_earlier_dispatches() {
    let gpu = Checked::open();
    let count = 1000;
    let start: Vec<u32> = (0..count).map(|i| 5 * i).collect();
    let buffer = gpu.upload_buffer("values", BufferUse::Storage, &bytes_of(&start)).unwrap();
    for factor in [3, 11] {
        let pipeline = fill(&gpu, factor);
        let group = gpu.bind(&pipeline, &[(0, Bound::Buffer(&buffer))]).unwrap();
        let time = gpu.run(&pipeline, &group, &bytes_of(&[100, count]), [count.div_ceil(64), 1, 1]).unwrap();
        assert!(time.device_seconds > 0.0, "{time:?}");
        // The device works inside the host's interval; a millisecond for the clocks' difference.
        assert!(time.device_seconds < time.wall_seconds + 1e-3, "{time:?}");
    }
    let expected: Vec<u32> = (0..count).map(|i| 5 * i + (100 * 3 + i) + (100 * 11 + i)).collect();
    assert_eq!(read_u32(&gpu, &buffer), expected);
}

#[test]
fn a_bind_group_keeps_its_resources_and_objects_outlive_the_gpu() {
    let checked = Checked::open();
    let pipeline = fill(&checked, 2);
    let bound = checked.upload_buffer("bound", BufferUse::Storage, &[0; 256]).unwrap();
    let group = checked.bind(&pipeline, &[(0, Bound::Buffer(&bound))]).unwrap();
    drop(bound);
    checked.run(&pipeline, &group, &bytes_of(&[1, 64]), [1, 1, 1]).unwrap();
    let kept = checked.upload_buffer("kept", BufferUse::Storage, &[0; 16]).unwrap();
    drop(checked);
    drop((kept, group, pipeline));
}

#[test]
fn dropped_objects_give_their_memory_back() {
    let gpu = Checked::open();
    // The staging buffer stays: let it grow to its final size first.
    drop(gpu.upload_buffer("first", BufferUse::Storage, &noise(20 << 20)).unwrap());
    let before = gpu.memory_in_use();
    let buffer = gpu.upload_buffer("second", BufferUse::Storage, &noise(20 << 20)).unwrap();
    let small = gpu.buffer("third", 100, BufferUse::TexelUint).unwrap();
    assert!(gpu.memory_in_use() >= before + (20 << 20) + 100);
    drop((buffer, small));
    assert_eq!(gpu.memory_in_use(), before);
}

#[test]
fn a_planted_mistake_reaches_the_messages() {
    let select = DeviceSelect::parse(&std::env::var("MOIRE_DEVICE").unwrap_or("cpu".into())).unwrap();
    let gpu = Gpu::open_with(&select, OpenOptions { validation: true }).unwrap();
    // The shader has eight bytes of push constants, and the description denies it.
    let planted = gpu.pipeline(&PipelineDesc {
        name: "planted",
        spirv: FILL,
        bindings: &[one(0, BindingKind::StorageBuffer)],
        push_constant_bytes: 0,
        constants: &[],
    });
    drop(planted);
    let messages = gpu.messages();
    if gpu.validation_active() {
        assert!(messages.iter().any(|m| m.contains("VUID-VkComputePipelineCreateInfo")), "{messages:#?}");
    } else {
        assert!(messages.is_empty());
        untested("what the validation layer would say: it is not installed");
    }
}

#[test]
fn without_validation_nothing_of_it_is_loaded() {
    let select = DeviceSelect::parse(&std::env::var("MOIRE_DEVICE").unwrap_or("cpu".into())).unwrap();
    let gpu = Gpu::open_with(&select, OpenOptions { validation: false }).unwrap();
    assert!(!gpu.validation_active());
    assert!(gpu.messages().is_empty());
}
