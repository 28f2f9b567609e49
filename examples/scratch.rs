use conemosaic::{detect::*, image::Plane};
use std::io::Write;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let opt = DetectOptions { modality: a.get(3).and_then(|m| m.parse().ok()), ..Default::default() };
    let mut files: Vec<_> = std::fs::read_dir(&a[1]).unwrap().map(|e| e.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "png")).collect();
    files.sort();
    std::fs::create_dir_all(&a[2]).unwrap();
    let t = std::time::Instant::now();
    let mut el = 0.;
    for f in &files {
        let im = image::open(f).unwrap().to_luma32f();
        let p = Plane::from_shape_vec((im.height() as usize, im.width() as usize), im.into_raw()).unwrap();
        let t1 = std::time::Instant::now();
        let d = detect(&p, &opt).unwrap();
        el += t1.elapsed().as_secs_f64();
        let mut o = std::fs::File::create(format!("{}/{}.csv", a[2], f.file_stem().unwrap().to_str().unwrap())).unwrap();
        writeln!(o, "x_px,y_px,score").unwrap();
        for c in &d.cones { writeln!(o, "{},{},{}", c.centre.x, c.centre.y, c.score).unwrap(); }
        println!("{} {:?} {:?} ring {:.2} str {:.2} s {:.2} n {}", f.file_stem().unwrap().to_str().unwrap(), d.modality, d.polarity, d.ring_spacing, d.ring_strength, d.spacing, d.cones.len());
    }
    eprintln!("{} images, total {:.2}s detect {:.2}s = {:.1}/s", files.len(), t.elapsed().as_secs_f64(), el, files.len() as f64 / el);
}
